#pragma once

#include <string>
#include <vector>

#include "detector/detection_settings.hpp"
#include "detector/features/feature_settings.hpp"
#include "detector/forest/patch_settings.hpp"
#include "detector/training/training_settings.hpp"

namespace houghstream {

struct Forest;

/// Everything that describes one way to train a forest and to search with it.
struct Profile {
  std::string name;
  FeatureSettings features;
  PatchSettings patch;
  training::TrainingSettings training;
  DetectionSettings detection;
};

/// The one place where the named settings are:
///
/// gall      (with detector/baseline only) the original Hough Forest (Gall et al. 2011) with the parameters of the
/// paper's Section 4: intensity only,
///           five scales of the image, patches of 16x16 pixels, every pixel; a detection's score is its votes' mass.
///           A patch votes for the objects that it takes for likelier than one of so many by chance.
/// paper     Section 6: final features, image scale 0.7, patches of 10x10 pixels (at 1 m), depth normalisation, every
///           pixel.
/// realtime  the default: half the image size (full size for what is far), at most every other pixel and patches
///           at most 22 mm apart, and what the first trees take for background is not shown to the others.
///
/// paper and realtime share what goes beyond the paper: 3-D votes, occluders in training, evidence, calibrated scores.
/// `objects`: how many are taught; the paper teaches four. Throws InputError that lists the names for an unknown name.
Profile make_profile(const std::string& name, std::size_t objects = 4);

std::vector<std::string> profile_names();

/// How a forest wants to be searched: the detection settings of the profile that it was trained by, for as many objects
/// as it knows.
DetectionSettings detection_settings(const Forest& forest);

/// Working size over frame size (paper, Section 5.1.1). What is counted in pixels, patches above all, is adjusted, so
/// that it covers as much of the frame as before; lengths in metres stay. To be called before set_scale_handling.
void set_image_scale(Profile& profile, float image_scale);

/// How distances are handled: "five" (scales, Gall et al. 2011), "single" (scale 1 only) or "normalised" (by depth,
/// Section 5.1.2; patches as large as at 1 m, about where turntables stand). Throws InputError for another word.
void set_scale_handling(Profile& profile, const std::string& handling);

}  // namespace houghstream
