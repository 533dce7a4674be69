#include "detector/baseline/surface_histograms.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/detector/baseline/surface_scene.hpp"

namespace houghstream::baseline {
namespace {

using Values = std::vector<int>;
using Family = std::vector<cv::Mat> (*)(const WorkingFrame&, const PointHistogramSettings&, int);

Values at(const std::vector<cv::Mat>& planes, int x, int y) {
  Values values;
  values.reserve(planes.size());
  for (const cv::Mat& plane : planes) values.push_back(plane.at<std::uint8_t>(y, x));
  return values;
}

int sum(const Values& values, std::size_t first, std::size_t last) {
  int total = 0;
  for (std::size_t i = first; i < last; ++i) total += values[i];
  return total;
}

/// Returns settings with few neighbours, as far apart as the pixels of these frames at 1 m.
PointHistogramSettings coarse() {
  PointHistogramSettings settings;
  settings.given = 16;
  settings.spacing = 0.004F;
  return settings;
}

WorkingFrame noisy_ball() {
  WorkingFrame frame = scene::ball_on_table(120, 90);
  scene::add_noise(frame, 0.001, 2);
  return frame;
}

TEST(SurfaceHistograms, OnAPlaneAllAnglesAreZero) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.4, -0.3, -0.8).normalized();
  const WorkingFrame frame = scene::see(48, 36, scene::Plane{normal, 0.8 * normal.z()});
  const std::vector<cv::Mat> fpfh = fpfh_planes(frame, {}, 1);
  const std::vector<cv::Mat> pfh = pfh_planes(frame, coarse(), 1);
  Values expected(33, 0);
  for (const std::size_t middle : {5U, 16U, 27U}) expected[middle] = 255;
  Values expected_pfh(125, 0);
  expected_pfh[62] = 255;
  for (const cv::Point p : {cv::Point(0, 0), cv::Point(24, 18), cv::Point(47, 35)}) {
    EXPECT_EQ(at(fpfh, p.x, p.y), expected) << p;
    EXPECT_EQ(at(pfh, p.x, p.y), expected_pfh) << p;
  }
}

TEST(SurfaceHistograms, ABallDiffersFromTheTableAndEachHistogramIsWhole) {
  const WorkingFrame frame = noisy_ball();
  const std::vector<cv::Mat> fpfh = fpfh_planes(frame, {}, 1);
  const Values ball = at(fpfh, 60, 45);
  const Values table = at(fpfh, 20, 80);
  for (const Values& values : {ball, table}) {
    for (const std::size_t first : {0U, 11U, 22U}) EXPECT_NEAR(sum(values, first, first + 11), 255, 6);
  }
  int difference = 0;
  for (std::size_t i = 0; i < ball.size(); ++i) difference += std::abs(ball[i] - table[i]);
  EXPECT_GT(difference, 200);
}

TEST(SurfaceHistograms, TheNumberOfBinsIsAsAsked) {
  PointHistogramSettings settings = coarse();
  settings.fpfh_bins = 7;
  settings.pfh_bins = 3;
  const WorkingFrame frame = noisy_ball();
  const std::vector<cv::Mat> fpfh = fpfh_planes(frame, settings, 1);
  ASSERT_EQ(fpfh.size(), 21U);
  EXPECT_NEAR(sum(at(fpfh, 60, 45), 0, 7), 255, 4);
  const std::vector<cv::Mat> pfh = pfh_planes(frame, settings, 1);
  ASSERT_EQ(pfh.size(), 27U);
  EXPECT_NEAR(sum(at(pfh, 60, 45), 0, 27), 255, 14);
}

TEST(SurfaceHistograms, AThinnerCloudKeepsItsSupport) {
  const WorkingFrame frame = noisy_ball();
  PointHistogramSettings full;
  full.step_px = 1;
  const Values dense = at(fpfh_planes(frame, full, 1), 61, 45);
  PointHistogramSettings half;
  half.step_px = 2;
  const Values thin = at(fpfh_planes(frame, half, 1), 61, 45);
  for (std::size_t i = 0; i < dense.size(); ++i) EXPECT_NEAR(thin[i], dense[i], 40) << i;
}

/// Returns a ball before nothing, in the middle of an image.
WorkingFrame ball_at(double distance, double radius, double enlarged) {
  const scene::Round ball{Eigen::Vector3d(0.0, 0.0, distance), radius};
  WorkingFrame frame = scene::see(80, 60, [&](const Eigen::Vector3d& ray) {
    return ball({ray.x() / enlarged, ray.y() / enlarged, 1.0});
  });
  frame.camera.fx *= enlarged;
  frame.camera.fy *= enlarged;
  return frame;
}

int difference(const Values& a, const Values& b) {
  int sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum;
}

TEST(SurfaceHistograms, ABallFarAwayInALargerImageIsTheSameALargerOneIsNot) {
  for (const Family family : {&fpfh_planes, &pfh_planes}) {
    const Values near = at(family(ball_at(0.7, 0.05, 1.0), coarse(), 1), 42, 30);
    const Values far = at(family(ball_at(1.4, 0.05, 2.0), coarse(), 1), 42, 30);
    const Values large = at(family(ball_at(1.4, 0.1, 1.0), coarse(), 1), 42, 30);
    EXPECT_LT(2 * difference(near, far), difference(near, large));
  }
}

TEST(SurfaceHistograms, PixelsWithoutASurfaceOrOnAnotherOneThanTheirCellAreNeutral) {
  WorkingFrame frame = scene::see(48, 36, scene::Plane{Eigen::Vector3d(0, 0, -1), -0.8});
  frame.filled_depth.colRange(24, 48).setTo(1.2);
  frame.filled_depth.rowRange(0, 8).setTo(scene::kNone);
  frame.filled_depth.at<float>(18, 12) = scene::kNone;  // beside the middle of its cell
  PointHistogramSettings settings = coarse();
  settings.step_px = 5;  // the cell of columns 20 to 24 has its middle on the near side
  for (const Family family : {&fpfh_planes, &pfh_planes}) {
    const std::vector<cv::Mat> planes = family(frame, settings, 1);
    const Values none(planes.size(), 0);
    EXPECT_EQ(at(planes, 12, 18), none);
    EXPECT_EQ(at(planes, 10, 3), none);
    EXPECT_EQ(at(planes, 24, 18), none);
    for (const int x : {11, 13, 23, 25}) EXPECT_NE(at(planes, x, 18), none) << x;
  }
}

TEST(SurfaceHistograms, AnyNumberOfThreadsGivesTheSamePlanes) {
  const WorkingFrame frame = noisy_ball();
  for (const Family family : {&fpfh_planes, &pfh_planes}) {
    EXPECT_TRUE(scene::same_planes(family(frame, coarse(), 1), family(frame, coarse(), 3)));
  }
}

}  // namespace
}  // namespace houghstream::baseline
