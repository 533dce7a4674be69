#include "detector/baseline/gall_profile.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "detector/features/feature_families.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/forest.hpp"
#include "detector/training/forest_trainer.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream::baseline {
namespace {

constexpr std::array<float, kMaxScales> kFiveScales = {0.33F, 0.66F, 1.0F, 1.66F, 2.33F};  // Section 4

/// Returns the prior probability of each of so many objects and the background: the released detector of the paper's
/// authors lets a patch vote for an object from this posterior on (its threshold_hierarchy is 1).
float even_fraction(std::size_t objects) {
  return 1.0F / static_cast<float>(objects + 1);
}

constexpr const char* kGallProfile = "gall";

}  // namespace

Profile gall_profile(std::size_t objects) {
  Profile profile;
  profile.name = kGallProfile;
  profile.features.families = kIntensity;
  profile.features.image_scale = 1.0F;
  profile.patch.radius = 8;
  profile.training.single_pixel_fraction = 0.0;  // differences only
  profile.training.negative_pool = 0;
  profile.training.sharpened_fraction = 0.0;  // the original sees its views as they were taken
  profile.training.max_background_weight = std::numeric_limits<float>::infinity();
  profile.training.scoring = Scoring::kVotes;
  profile.training.max_leaf_votes = 32;
  profile.detection.spacing.stride = 1;
  profile.detection.spacing.metres = 0.0F;
  profile.detection.leaves.first_trees = 0;
  profile.detection.evidence.threshold = 0.1F;
  profile.detection.voting.min_mass_fraction = 0.05F;
  profile.detection.leaves.min_class_fraction = even_fraction(objects);
  set_scale_handling(profile, "five");
  return profile;
}

std::vector<std::string> profile_names() {
  std::vector<std::string> names = houghstream::profile_names();
  names.insert(names.begin(), kGallProfile);
  return names;
}

Profile make_profile(const std::string& name, std::size_t objects) {
  if (name == kGallProfile) return gall_profile(objects);
  const std::vector<std::string> known = profile_names();
  require(std::find(known.begin(), known.end(), name) != known.end(), "profile '{}', expected one of {}", name,
          fmt::join(known, ", "));
  return houghstream::make_profile(name);
}

DetectionSettings detection_settings_of(const Forest& forest) {
  Profile profile = make_profile(forest.profile, forest.classes.size());
  profile.features.image_scale = forest.features.image_scale;
  const bool normalised = forest.features.handling == ScaleHandling::kDepthNormalised;
  set_scale_handling(profile, normalised ? "normalised" : "five");  // any number of scales serves here
  return profile.detection;
}

Profile profile_of(const Forest& forest) {
  Profile named = make_profile(forest.profile);
  named.detection = detection_settings_of(forest);
  return training::profile_of(forest, named);
}

void set_image_scale(Profile& profile, float image_scale) {
  FeatureSettings& features = profile.features;
  if (features.handling == ScaleHandling::kScaleSpace) {  // counts patches in pixels
    const float ratio = image_scale / features.image_scale;
    profile.patch.radius = std::max(1, static_cast<int>(std::lround(ratio * static_cast<float>(profile.patch.radius))));
  }
  features.image_scale = image_scale;
}

void set_scale_handling(Profile& profile, const std::string& handling) {
  FeatureSettings& features = profile.features;
  if (handling == "normalised") {
    if (features.handling == ScaleHandling::kDepthNormalised) return;
    constexpr float kTaughtDistance = 1.0F;  // metres: about where turntables stand (Lai et al. 2011)
    features.handling = ScaleHandling::kDepthNormalised;
    features.scales = {};
    features.far_distance = features.max_distance;
    profile.patch.unit = kTaughtDistance / (features.image_scale * kReferenceFocal_px);
    profile.training.merge_radius = training::TrainingSettings{}.merge_radius;
    profile.detection.voting.vote_sigma = DetectionSettings{}.voting.vote_sigma;
    return;
  }
  require(handling == "five" || handling == "single", "scale handling '{}', expected five, single or normalised",
          handling);
  features.handling = ScaleHandling::kScaleSpace;
  features.scales = handling == "five" ? kFiveScales : std::array<float, kMaxScales>{1.0F};
  profile.patch.unit = 1.0F;
  // Offsets are counted as at 1 m: see FeatureSettings::handling.
  profile.training.merge_radius = 2.0F / kReferenceFocal_px;
  profile.detection.voting.vote_sigma = 3.0F / kReferenceFocal_px;
}

}  // namespace houghstream::baseline
