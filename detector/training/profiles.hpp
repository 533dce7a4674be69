#pragma once

#include <string>

#include "detector/detection_settings.hpp"
#include "detector/features/feature_settings.hpp"
#include "detector/features/patch_settings.hpp"
#include "detector/training/training_settings.hpp"

namespace houghstream {

/// Everything that describes one way to train a forest and to search with it.
struct Profile {
  std::string name;
  FeatureSettings features;
  PatchSettings patch;
  training::TrainingSettings training;
  DetectionSettings detection;
};

/// The one place where the named settings are, but for how they search, see detection_settings.hpp:
///
/// paper     Section 6: final features, image scale 0.7, patches of 10x10 pixels (at 1 m), depth normalisation, every
///           pixel.
/// realtime  the default: half the image size (full size for what is far), at most every other pixel and patches
///           at most 22 mm apart, and what the first trees take for background is not shown to the others.
///
/// Makes a profile. All share what goes beyond the paper: 3-D votes, occluders in training, evidence, calibrated
/// scores. The original is baseline::gall_profile. Throws InputError that lists the names for an unknown name.
Profile make_profile(const std::string& name);

}  // namespace houghstream
