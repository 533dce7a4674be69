#include "detector/baseline/surface_curvature.hpp"

#include <gtest/gtest.h>

#include "tests/detector/baseline/surface_scene.hpp"

namespace houghstream::baseline {
namespace {

using Layout = CurvatureLayout;
using Values = std::vector<int>;
constexpr int kFlat = 128;

Values curvature_at_centre(const std::vector<cv::Mat>& planes) {
  Values values;
  values.reserve(planes.size());
  for (const cv::Mat& plane : planes) values.push_back(plane.at<std::uint8_t>(30, 30));
  return values;
}

Values curvature_at_centre(const WorkingFrame& frame) {
  return curvature_at_centre(curvature_planes(frame, 1));
}

/// Returns the features of a surface of this radius with its front at the middle pixel, for a window of 15 pixels.
double expected_spread(double radius, double distance) {
  const double width = 15.0 / 260.0 * distance;
  return 255.0 * width / (radius * std::sqrt(12.0)) / Layout::kFullSpread;
}

WorkingFrame round(double radius, const Eigen::Vector3d& axis) {
  return scene::see(61, 61, scene::Round{Eigen::Vector3d(0.0, 0.0, 0.8 + radius), radius, axis});
}

TEST(SurfaceCurvature, APlaneHasNone) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.5, -0.3, -0.8).normalized();
  WorkingFrame frame = scene::see(61, 61, scene::Plane{normal, 0.8 * normal.z()});
  const Values exact = curvature_at_centre(frame);
  ASSERT_EQ(exact.size(), static_cast<std::size_t>(Layout::kPlanes));
  EXPECT_LE(exact[Layout::kMax], 1);
  scene::add_noise(frame, 0.001, 1);
  EXPECT_LE(curvature_at_centre(frame)[Layout::kMax], 12);
}

TEST(SurfaceCurvature, ASphereIsCurvedAlikeInAllDirections) {
  for (const double radius : {0.06, 0.12}) {
    WorkingFrame frame = round(radius, Eigen::Vector3d::Zero());
    const Values values = curvature_at_centre(frame);
    const double expected = expected_spread(radius, 0.8);
    EXPECT_NEAR(values[Layout::kMax], expected, 0.1 * expected);
    EXPECT_NEAR(values[Layout::kMin], expected, 0.1 * expected);
    EXPECT_GT(values[Layout::kRatio], 250);
    EXPECT_NEAR(values[Layout::kDirection], kFlat, 3);
    EXPECT_NEAR(values[Layout::kDirection + 1], kFlat, 3);
  }
}

TEST(SurfaceCurvature, ACylinderIsCurvedAcrossItsAxis) {
  for (int angle = 0; angle < 4; ++angle) {
    const double axis_angle = angle * M_PI / 4.0;  // in the image; the principal direction is at right angles to it
    WorkingFrame frame = round(0.08, {std::cos(axis_angle), std::sin(axis_angle), 0.0});
    scene::add_noise(frame, 0.0003, 1);
    const Values values = curvature_at_centre(frame);
    EXPECT_GT(values[Layout::kMax], 0.85 * expected_spread(0.08, 0.8));
    EXPECT_LT(values[Layout::kMin], 12);
    EXPECT_LT(values[Layout::kRatio], 40);
    EXPECT_NEAR(values[Layout::kDirection], kFlat - 127 * std::cos(2 * axis_angle), 12) << angle;
    EXPECT_NEAR(values[Layout::kDirection + 1], kFlat - 127 * std::sin(2 * axis_angle), 12) << angle;
  }
}

TEST(SurfaceCurvature, AStepInDepthIsNone) {
  const WorkingFrame frame = scene::see(61, 61, [](const Eigen::Vector3d& ray) { return ray.x() <= 0.0 ? 0.8 : 0.9; });
  EXPECT_LE(curvature_at_centre(frame)[Layout::kMax], 1);
}

TEST(SurfaceCurvature, MissingDepthIsNeutralAndDoesNotSpread) {
  WorkingFrame frame = round(0.08, {0.0, 1.0, 0.0});
  const std::vector<cv::Mat> whole = curvature_planes(frame, 1);
  frame.filled_depth.at<float>(30, 30) = scene::kNone;
  const std::vector<cv::Mat> planes = curvature_planes(frame, 1);
  EXPECT_EQ(curvature_at_centre(planes), (Values{0, 0, kFlat, kFlat, 0}));
  EXPECT_NEAR(planes[Layout::kMax].at<std::uint8_t>(30, 31), whole[Layout::kMax].at<std::uint8_t>(30, 31), 3);
}

TEST(SurfaceCurvature, AnyNumberOfThreadsGivesTheSamePlanes) {
  WorkingFrame frame = scene::ball_on_table();
  scene::add_noise(frame, 0.002, 2);
  EXPECT_TRUE(scene::same_planes(curvature_planes(frame, 1), curvature_planes(frame, 3)));
}

}  // namespace
}  // namespace houghstream::baseline
