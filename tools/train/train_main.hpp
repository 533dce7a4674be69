#pragma once

#include <functional>
#include <string>
#include <vector>

#include "detector/features/feature_families.hpp"
#include "detector/training/forest_trainer.hpp"

namespace houghstream {

/// Settings of a program that trains; the defaults are those of hs-train.
struct TrainProgram {
  std::string name = "hs-train";
  std::vector<std::string> profiles = profile_names();  ///< those that it offers
  std::uint32_t families = kTileFamilies;               ///< those that it offers
  std::function<Profile(const std::string&)> make_profile = houghstream::make_profile;
  std::function<Profile(const Forest&)> profile_of = [](const Forest& it) { return training::profile_of(it); };
  std::function<const training::Scales&(const FeatureSettings&)> scales_of =
      [](const FeatureSettings&) -> const training::Scales& { return training::depth_normalised_scales(); };
  std::function<void(Profile&, float)> set_image_scale = [](Profile& profile, float image_scale) {
    profile.features.image_scale = image_scale;
  };
  /// Handler of --scale; none where it has one handling only.
  std::function<void(Profile&, const std::string&)> set_scale_handling;
};

/// Runs hs-train, and hs-study train, which trains by detector/baseline too.
int train_main(int argc, char** argv, const TrainProgram& program = {});

}  // namespace houghstream
