#include "detector/features/feature_families.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

FeatureLayout layout_of(std::uint32_t families, ScaleHandling handling = ScaleHandling::kDepthNormalised) {
  FeatureSettings settings;
  settings.families = families;
  settings.handling = handling;
  return FeatureLayout(settings);
}

std::string error_for(const std::string& names) {
  try {
    parse_families(names);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FeatureFamilies, NamesBecomeBitsAndBack) {
  EXPECT_EQ(parse_families("intensity"), kIntensity);
  EXPECT_EQ(parse_families("fpfh,depth_value"), kDepthValue | kFastHistogram);
  for (std::uint32_t families = 1; families < 256; ++families) {
    ASSERT_EQ(parse_families(family_names(families)), families);
  }
  EXPECT_EQ(family_names(kHonv | kIntensity), "intensity,honv");
}

TEST(FeatureFamilies, UnknownNamesAndNoneAreRefusedWithTheKnownOnes) {
  for (const char* names : {"colour", "intensity,colour", "", "intensity,,honv", "Intensity"}) {
    const std::string error = error_for(names);
    EXPECT_NE(error.find("depth_derivatives, depth_hog"), std::string::npos) << names << ": " << error;
  }
  EXPECT_NE(error_for("intensity,colour").find("'colour'"), std::string::npos);
}

TEST(FeatureLayout, BlocksFollowEachOtherWithoutGaps) {
  for (std::uint32_t families = 1; families < 256; ++families) {
    const FeatureLayout layout = layout_of(families);
    int next = 0;
    std::uint32_t seen = 0;
    for (const FeatureBlock& block : layout.blocks()) {
      ASSERT_EQ(block.first, next);
      ASSERT_EQ(layout.block(block.family).first, next);
      next += block.planes();
      seen |= block.family;
    }
    ASSERT_EQ(layout.planes(), next);
    ASSERT_EQ(seen, families);
    ASSERT_GE(layout.pixel_stride(), next);
    ASSERT_LT(layout.pixel_stride(), next + 32);
    ASSERT_EQ(layout.pixel_stride() % 32, 0);
  }
}

TEST(FeatureLayout, HasThePlanesOfThePaper) {
  EXPECT_EQ(layout_of(kIntensity).planes(), 32);  // minimum and maximum of 16
  EXPECT_EQ(layout_of(kDepthValue).planes(), 2);
  EXPECT_EQ(layout_of(kDepthDerivatives).planes(), 8);
  EXPECT_EQ(layout_of(kDepthHog).planes(), 18);
  EXPECT_EQ(layout_of(kHonv).planes(), 12);
  EXPECT_EQ(layout_of(kCurvature).planes(), 10);
  EXPECT_EQ(layout_of(kPointHistogram).planes(), 125);
  EXPECT_EQ(layout_of(kFastHistogram).planes(), 33);
  EXPECT_EQ(FeatureLayout().planes(), 60);
}

TEST(FeatureLayout, AFamilyThatIsNotThereIsRefused) {
  EXPECT_THROW(layout_of(kIntensity).block(kHonv), InputError);
}

TEST(FeatureLayout, DepthWrapsUnlessTheImageIsSearchedInSizes) {
  for (const ScaleHandling handling : {ScaleHandling::kDepthNormalised, ScaleHandling::kScaleSpace}) {
    const FeatureLayout layout = layout_of(255, handling);
    const PlaneKind depth = handling == ScaleHandling::kScaleSpace ? PlaneKind::kScaledDepth : PlaneKind::kWrappedDepth;
    for (const FeatureBlock& block : layout.blocks()) {
      PlaneKind expected = PlaneKind::kSurface;
      if (block.family == kIntensity) expected = PlaneKind::kIntensity;
      if (block.family == kDepthValue) expected = depth;
      if (block.family == kPointHistogram || block.family == kFastHistogram) expected = PlaneKind::kHistogram;
      for (int p = block.first; p < block.first + block.planes(); ++p) ASSERT_EQ(layout.kind(p), expected) << p;
    }
  }
}

}  // namespace
}  // namespace houghstream
