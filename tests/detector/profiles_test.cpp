#include "detector/profiles.hpp"

#include <gtest/gtest.h>

#include "detector/features/feature_families.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

constexpr double kFocal = 525.0;  // of the cameras that the profiles have in mind

Forest forest_of(const Profile& profile) {
  Forest forest;
  forest.profile = profile.name;
  forest.features = profile.features;
  forest.classes.resize(4);
  return forest;
}

TEST(Profiles, AreKnownByTheirNames) {
  for (const std::string& name : profile_names()) EXPECT_EQ(make_profile(name).name, name);
  EXPECT_EQ(profile_names().size(), 3U);
}

TEST(Profiles, UnknownNamesAreRefusedWithTheKnownOnes) {
  try {
    make_profile("Gall");
    FAIL() << "expected an error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'Gall', expected one of gall, paper, realtime"), std::string::npos)
        << error.what();
  }
}

TEST(Profiles, GallIsTheOriginalHoughForest) {
  const Profile gall = make_profile("gall");
  EXPECT_EQ(gall.features.families, kIntensity);
  EXPECT_EQ(gall.features.handling, ScaleHandling::kScaleSpace);
  EXPECT_EQ(gall.patch.radius, 8);  // patches of 16x16 pixels, whatever their depth
  EXPECT_EQ(limited_scale(gall.patch, gall.patch.unit), 256);
  EXPECT_EQ(gall.training.scoring, Scoring::kVotes);
  EXPECT_EQ(gall.training.alone_share, 0.0);
  EXPECT_EQ(gall.detection.spacing.stride, 1);
  EXPECT_EQ(gall.detection.leaves.first_trees, 0);
  std::vector<float> sizes;
  for (const FeatureLevel& level : feature_levels(gall.features)) sizes.push_back(level.scale);
  EXPECT_EQ(sizes, (std::vector<float>{0.33F, 0.66F, 1.0F, 1.66F, 2.33F}));
}

TEST(Profiles, PaperHasPatchesOfTenPixelsAtOneMetre) {
  const Profile paper = make_profile("paper");
  EXPECT_EQ(paper.patch.radius, 5);
  EXPECT_NEAR(patch_scale(paper.patch, paper.features.image_scale * kFocal, 1.0F), 256, 1);
  EXPECT_EQ(paper.features.families, kIntensity | kDepthValue | kDepthDerivatives | kDepthHog);
  EXPECT_EQ(paper.features.handling, ScaleHandling::kDepthNormalised);
  EXPECT_EQ(feature_levels(paper.features).size(), 1U);
  EXPECT_EQ(paper.detection.spacing.stride, 1);
  EXPECT_EQ(paper.detection.spacing.metres, 0.0F);
  EXPECT_EQ(paper.detection.leaves.first_trees, 0);
}

TEST(Profiles, RealtimeLooksAtFewerPixelsThanPaper) {
  const Profile realtime = make_profile("realtime");
  EXPECT_LT(realtime.features.image_scale, make_profile("paper").features.image_scale);
  EXPECT_EQ(realtime.detection.spacing.stride, 2);
  EXPECT_GT(realtime.detection.spacing.metres, 0.0F);
  EXPECT_GT(realtime.detection.leaves.first_trees, 0);
  EXPECT_EQ(realtime.features.families, make_profile("paper").features.families);
  EXPECT_EQ(feature_levels(realtime.features).size(), 2U);
}

TEST(ScaleHandling, ASingleScaleIsTheTaughtOne) {
  Profile profile = make_profile("gall");
  set_scale_handling(profile, "single");
  const std::vector<FeatureLevel> levels = feature_levels(profile.features);
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
      const DetectionSettings settings = detection_settings(forest_of(profile));
      EXPECT_EQ(settings.voting.vote_sigma, profile.detection.voting.vote_sigma) << name << " " << handling;
      EXPECT_EQ(settings.spacing.stride, profile.detection.spacing.stride);
      EXPECT_EQ(settings.spacing.metres, profile.detection.spacing.metres);
      EXPECT_EQ(settings.leaves.first_trees, profile.detection.leaves.first_trees);
      EXPECT_EQ(settings.evidence.threshold, profile.detection.evidence.threshold);
      EXPECT_EQ(settings.voting.min_mass_share, profile.detection.voting.min_mass_share);
      EXPECT_EQ(settings.leaves.min_class_share, profile.detection.leaves.min_class_share);
    }
  }
}

TEST(ForestsSettings, GallsPatchesVoteForWhatIsLikelierThanByChance) {
  Forest forest = forest_of(make_profile("gall"));
  EXPECT_EQ(detection_settings(forest).leaves.min_class_share, 0.2F);  // four objects and the background
  forest.classes.resize(7);
  EXPECT_EQ(detection_settings(forest).leaves.min_class_share, 0.125F);
  forest = forest_of(make_profile("realtime"));
  const float ours = detection_settings(forest).leaves.min_class_share;
  forest.classes.resize(20);
  EXPECT_EQ(detection_settings(forest).leaves.min_class_share, ours);
}

float patch_reach(const Profile& profile) {
  return profile.patch.unit * static_cast<float>(profile.patch.radius);
}

TEST(Profiles, UnknownNamesAreRefused) {
  EXPECT_THROW(make_profile("fast"), InputError);
  Profile profile = make_profile("gall");
  EXPECT_THROW(set_scale_handling(profile, "seven"), InputError);
}

TEST(Profiles, PatchesOfAScaleSpaceShrinkWithTheImage) {
  Profile profile = make_profile("gall");
  const float smoothing = profile.detection.voting.vote_sigma;
  set_image_scale(profile, 0.5F);
  EXPECT_EQ(profile.features.image_scale, 0.5F);
  EXPECT_EQ(profile.patch.radius, 4);
  set_scale_handling(profile, "five");
  EXPECT_EQ(profile.patch.unit, 1.0F);
  EXPECT_EQ(profile.detection.voting.vote_sigma, smoothing);  // counted as on an object at 1 m
}

TEST(Profiles, PatchesOfTheTiniestImageHaveAnExtent) {
  Profile profile = make_profile("gall");
  set_image_scale(profile, 0.01F);
  EXPECT_EQ(profile.patch.radius, 1);
}

TEST(Profiles, DepthNormalisedPatchesCoverTheSameSurfaceInAnyImageSize) {
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
}  // namespace houghstream
