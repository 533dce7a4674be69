#include "detector/baseline/gall_profile.hpp"

#include <gtest/gtest.h>

#include "detector/baseline/scale_space_search.hpp"
#include "detector/features/feature_families.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::baseline {
namespace {

constexpr double kFocal = 525.0;  // focal length of the cameras that the profiles assume

Forest forest_of(const Profile& profile) {
  Forest forest;
  forest.profile = profile.name;
  forest.features = profile.features;
  forest.classes.resize(4);
  return forest;
}

TEST(GallProfile, IsKnownBesideThoseOfTheProduct) {
  EXPECT_EQ(profile_names(), (std::vector<std::string>{"gall", "paper", "realtime"}));
  for (const std::string& name : profile_names()) EXPECT_EQ(make_profile(name).name, name);
  expect_says(error_of([&] { make_profile("Gall"); }), {"'Gall', expected one of gall, paper, realtime"});
}

TEST(GallProfile, IsTheOriginalHoughForest) {
  const Profile gall = make_profile("gall");
  EXPECT_EQ(gall.features.families, kIntensity);
  EXPECT_EQ(gall.features.handling, ScaleHandling::kScaleSpace);
  EXPECT_EQ(gall.patch.radius, 8);  // patches of 16x16 pixels, whatever their depth
  EXPECT_EQ(limited_scale(gall.patch, gall.patch.unit), 256);
  EXPECT_EQ(gall.training.scoring, Scoring::kVotes);
  EXPECT_EQ(gall.training.single_pixel_fraction, 0.0);
  EXPECT_EQ(gall.detection.spacing.stride, 1);
  EXPECT_EQ(gall.detection.leaves.first_trees, 0);
  std::vector<float> sizes;
  for (const FeatureLevel& level : scale_space_levels(gall.features)) sizes.push_back(level.scale);
  EXPECT_EQ(sizes, (std::vector<float>{0.33F, 0.66F, 1.0F, 1.66F, 2.33F}));
}

TEST(ScaleHandling, ASingleScaleIsTheTaughtOne) {
  Profile profile = make_profile("gall");
  set_scale_handling(profile, "single");
  const std::vector<FeatureLevel> levels = scale_space_levels(profile.features);
  ASSERT_EQ(levels.size(), 1U);
  EXPECT_EQ(levels[0].size_ratio, 1.0F);
  EXPECT_EQ(levels[0].scale, profile.features.image_scale);
}

TEST(ScaleHandling, NormalisedPatchesAreAsLargeWhereObjectsAreTaught) {
  Profile profile = make_profile("gall");
  const int in_scale_space = limited_scale(profile.patch, profile.patch.unit);
  set_scale_handling(profile, "normalised");
  EXPECT_EQ(profile.features.handling, ScaleHandling::kDepthNormalised);
  EXPECT_NEAR(patch_scale(profile.patch, kFocal, 1.0F), in_scale_space, 1);
  EXPECT_NEAR(patch_scale(profile.patch, kFocal, 2.0F), 0.5 * in_scale_space, 1);
  EXPECT_EQ(feature_levels(profile.features).size(), 1U);
  EXPECT_EQ(profile.detection.voting.vote_sigma, DetectionSettings{}.voting.vote_sigma);
  EXPECT_EQ(profile.training.merge_radius, training::TrainingSettings{}.merge_radius);
}

TEST(ScaleHandling, WhatIsNormalisedAlreadyStaysAsItIs) {
  Profile profile = make_profile("realtime");
  set_scale_handling(profile, "normalised");
  EXPECT_EQ(profile.patch.unit, make_profile("realtime").patch.unit);
  EXPECT_EQ(feature_levels(profile.features).size(), 2U);
}

TEST(ScaleHandling, AnotherWordIsRefused) {
  Profile profile = make_profile("gall");
  EXPECT_THROW(set_scale_handling(profile, "six"), InputError);
  EXPECT_THROW(set_scale_handling(profile, ""), InputError);
}

TEST(ForestsSettings, AreThoseItWasTrainedBy) {
  for (const std::string& name : profile_names()) {
    for (const char* handling : {"five", "single", "normalised"}) {
      Profile profile = make_profile(name);
      set_scale_handling(profile, handling);
      const DetectionSettings settings = detection_settings_of(forest_of(profile));
      EXPECT_EQ(settings.voting.vote_sigma, profile.detection.voting.vote_sigma) << name << " " << handling;
      EXPECT_EQ(settings.spacing.stride, profile.detection.spacing.stride);
      EXPECT_EQ(settings.spacing.metres, profile.detection.spacing.metres);
      EXPECT_EQ(settings.leaves.first_trees, profile.detection.leaves.first_trees);
      EXPECT_EQ(settings.evidence.threshold, profile.detection.evidence.threshold);
      EXPECT_EQ(settings.voting.min_mass_fraction, profile.detection.voting.min_mass_fraction);
      EXPECT_EQ(settings.leaves.min_class_fraction, profile.detection.leaves.min_class_fraction);
    }
  }
}

TEST(ForestsSettings, OfTheProductsProfilesAreTheProducts) {
  for (const std::string& name : houghstream::profile_names()) {
    const Forest forest = forest_of(make_profile(name));
    const DetectionSettings own = detection_settings_of(forest);
    const DetectionSettings products = houghstream::detection_settings(forest);
    EXPECT_EQ(own.spacing.stride, products.spacing.stride) << name;
    EXPECT_EQ(own.spacing.metres, products.spacing.metres) << name;
    EXPECT_EQ(own.leaves.first_trees, products.leaves.first_trees) << name;
    EXPECT_EQ(own.voting.vote_sigma, products.voting.vote_sigma) << name;
  }
}

TEST(ForestsSettings, GallsPatchesVoteForWhatIsLikelierThanByChance) {
  Forest forest = forest_of(make_profile("gall"));
  EXPECT_EQ(detection_settings_of(forest).leaves.min_class_fraction, 0.2F);  // four objects and the background
  forest.classes.resize(7);
  EXPECT_EQ(detection_settings_of(forest).leaves.min_class_fraction, 0.125F);
  forest = forest_of(make_profile("realtime"));
  const float ours = detection_settings_of(forest).leaves.min_class_fraction;
  forest.classes.resize(20);
  EXPECT_EQ(detection_settings_of(forest).leaves.min_class_fraction, ours);
}

float patch_reach(const Profile& profile) {
  return profile.patch.unit * static_cast<float>(profile.patch.radius);
}

TEST(GallProfile, PatchesOfAScaleSpaceShrinkWithTheImage) {
  Profile profile = make_profile("gall");
  const float smoothing = profile.detection.voting.vote_sigma;
  set_image_scale(profile, 0.5F);
  EXPECT_EQ(profile.features.image_scale, 0.5F);
  EXPECT_EQ(profile.patch.radius, 4);
  set_scale_handling(profile, "five");
  EXPECT_EQ(profile.patch.unit, 1.0F);
  EXPECT_EQ(profile.detection.voting.vote_sigma, smoothing);  // counted as on an object at 1 m
}

TEST(GallProfile, PatchesOfTheTiniestImageHaveAnExtent) {
  Profile profile = make_profile("gall");
  set_image_scale(profile, 0.01F);
  EXPECT_EQ(profile.patch.radius, 1);
}

TEST(GallProfile, DepthNormalisedPatchesCoverTheSameSurfaceInAnyImageSize) {
  for (const char* name : {"paper", "realtime"}) {
    Profile profile = make_profile(name);
    const float reach = patch_reach(profile);
    set_image_scale(profile, 0.25F);
    EXPECT_EQ(patch_reach(profile), reach) << name;
  }
  Profile whole = make_profile("gall");
  set_scale_handling(whole, "normalised");
  Profile half = make_profile("gall");
  set_image_scale(half, 0.5F);
  set_scale_handling(half, "normalised");
  EXPECT_FLOAT_EQ(patch_reach(half), patch_reach(whole));
}

}  // namespace
}  // namespace houghstream::baseline
