#include "detector/baseline/surface_planes.hpp"

#include <gtest/gtest.h>

#include "detector/baseline/surface_curvature.hpp"
#include "detector/baseline/surface_histograms.hpp"
#include "detector/baseline/surface_honv.hpp"
#include "tests/detector/baseline/surface_scene.hpp"

namespace houghstream::baseline {
namespace {

using scene::same_planes;

TEST(SurfacePlanes, EachSurfaceFamilyHasThePlanesOfItsBlock) {
  const WorkingFrame frame = scene::ball_on_table(60, 44);
  for (const FamilyName& name : kFamilyNames) {
    FeatureSettings settings;
    settings.families = name.family;
    const bool surface = is_surface_family(name.family);
    const int expected = surface ? FeatureLayout(settings).block(name.family).count : 0;
    const std::vector<cv::Mat> planes = surface_planes(name.family, frame, 1);
    ASSERT_EQ(static_cast<int>(planes.size()), expected) << name.name;
    int told = 0;
    for (const cv::Mat& plane : planes) {
      ASSERT_EQ(plane.size(), frame.filled_depth.size()) << name.name;
      ASSERT_EQ(plane.type(), CV_8UC1) << name.name;
      told += cv::countNonZero(plane);
    }
    EXPECT_EQ(told > 0, surface) << name.name;
  }
}

TEST(SurfacePlanes, AreThoseOfTheirFamilyForAnyNumberOfThreads) {
  const WorkingFrame frame = scene::ball_on_table(60, 44);
  PointHistogramSettings few;
  few.given = 20;
  EXPECT_TRUE(same_planes(surface_planes(kHonv, frame, 3), honv_planes(frame, 1)));
  EXPECT_TRUE(same_planes(surface_planes(kCurvature, frame, 3), curvature_planes(frame, 1)));
  EXPECT_TRUE(same_planes(surface_planes(kPointHistogram, frame, 3), pfh_planes(frame, few, 1)));
  EXPECT_TRUE(same_planes(surface_planes(kFastHistogram, frame, 3), fpfh_planes(frame, {}, 1)));
}

TEST(SurfacePlanes, ExtraOnesAreThoseOfTheSettings) {
  const WorkingFrame frame = scene::ball_on_table(60, 44);
  FeatureSettings settings;
  settings.families = kIntensity | kHonv | kCurvature;
  const ExtraPlanes extra = extra_planes(frame, settings, 2);
  ASSERT_EQ(extra.size(), 2U);
  EXPECT_TRUE(same_planes(extra.at(kHonv), honv_planes(frame, 1)));
  EXPECT_TRUE(same_planes(extra.at(kCurvature), curvature_planes(frame, 1)));
  EXPECT_TRUE(extra_planes(frame, {}, 2).empty());
}

}  // namespace
}  // namespace houghstream::baseline
