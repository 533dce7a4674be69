#include "detector/training/profiles.hpp"

#include <gtest/gtest.h>

#include "detector/features/feature_families.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

constexpr double kFocal = 525.0;  // focal length of the cameras that the profiles assume

TEST(Profiles, AreKnownByTheirNames) {
  for (const std::string& name : profile_names()) EXPECT_EQ(make_profile(name).name, name);
  EXPECT_EQ(profile_names(), (std::vector<std::string>{"paper", "realtime"}));
}

TEST(Profiles, UnknownNamesAreRefusedWithTheKnownOnesAndThoseWhoKnowMore) {
  for (const char* name : {"gall", "Realtime", ""}) {
    try {
      make_profile(name);
      ADD_FAILURE() << "expected an error: " << name;
    } catch (const InputError& error) {
      const std::string words = error.what();
      EXPECT_NE(words.find(std::string("'") + name + "', expected one of paper, realtime"), std::string::npos) << words;
      EXPECT_NE(words.find("hs-study train"), std::string::npos) << words;
    }
  }
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

TEST(Profiles, ForestsAreSearchedAsTheirProfileSays) {
  for (const std::string& name : profile_names()) {
    Forest forest;
    forest.profile = name;
    const DetectionSettings expected = make_profile(name).detection;
    const DetectionSettings settings = detection_settings(forest);
    EXPECT_EQ(settings.spacing.stride, expected.spacing.stride) << name;
    EXPECT_EQ(settings.spacing.metres, expected.spacing.metres) << name;
    EXPECT_EQ(settings.leaves.first_trees, expected.leaves.first_trees) << name;
  }
  Forest other;
  other.profile = "other";
  EXPECT_THROW(detection_settings(other), InputError);
}

}  // namespace
}  // namespace houghstream
