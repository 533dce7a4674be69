#include "detector/baseline/surface_honv.hpp"

#include <gtest/gtest.h>

#include "tests/detector/baseline/surface_scene.hpp"

namespace houghstream::baseline {
namespace {

using Values = std::vector<int>;
constexpr double kDegree = M_PI / 180.0;

Values values_at(const std::vector<cv::Mat>& planes, int x, int y) {
  Values values;
  values.reserve(planes.size());
  for (const cv::Mat& plane : planes) values.push_back(plane.at<std::uint8_t>(y, x));
  return values;
}

/// Returns a plane whose normal leaves the optical axis by `zenith`, towards `azimuth` (0: right, 90: down).
WorkingFrame tilted(double azimuth_deg, double zenith_deg) {
  const double across = std::sin(zenith_deg * kDegree);
  const Eigen::Vector3d normal(across * std::cos(azimuth_deg * kDegree), across * std::sin(azimuth_deg * kDegree),
                               -std::cos(zenith_deg * kDegree));
  return scene::see(41, 41, scene::Plane{normal, 0.9 * normal.z()});
}

void expect_bins(const Values& found, const std::vector<std::pair<int, int>>& expected) {
  ASSERT_EQ(found.size(), static_cast<std::size_t>(HonvLayout::kPlanes));
  Values all(HonvLayout::kPlanes, 0);
  for (const auto& [plane, value] : expected) all[static_cast<std::size_t>(plane)] = value;
  for (std::size_t p = 0; p < all.size(); ++p) EXPECT_NEAR(found[p], all[p], 3) << "plane " << p;
}

TEST(SurfaceHonv, TheMiddleOfABinTakesAll) {
  for (int azimuth = 0; azimuth < 4; ++azimuth) {
    for (int zenith = 0; zenith < 3; ++zenith) {
      const WorkingFrame frame = tilted(90.0 * azimuth, 15.0 + 30.0 * zenith);
      expect_bins(values_at(honv_planes(frame, 1), 20, 20), {{HonvLayout::plane(azimuth, zenith), 255}});
    }
  }
}

TEST(SurfaceHonv, BetweenBinsANormalIsShared) {
  expect_bins(values_at(honv_planes(tilted(315.0, 45.0), 1), 20, 20),
              {{HonvLayout::plane(3, 1), 128}, {HonvLayout::plane(0, 1), 128}});
  expect_bins(values_at(honv_planes(tilted(90.0, 37.5), 1), 20, 20),
              {{HonvLayout::plane(1, 0), 64}, {HonvLayout::plane(1, 1), 191}});
}

TEST(SurfaceHonv, FaceOnThereIsNoAzimuth) {
  expect_bins(values_at(honv_planes(tilted(0.0, 0.0), 1), 20, 20), {{0, 64}, {1, 64}, {2, 64}, {3, 64}});
  expect_bins(values_at(honv_planes(tilted(0.0, 7.5), 1), 20, 20), {{0, 159}, {1, 32}, {2, 32}, {3, 32}});
}

TEST(SurfaceHonv, BothSidesOfAnEdgeAreCountedAndAnotherSurfaceIsNot) {
  const scene::Plane left{Eigen::Vector3d(-0.5, 0.0, -0.866), -0.8};
  const scene::Plane right{Eigen::Vector3d(0.5, 0.0, -0.866), -0.8};
  const auto roof = [&](const Eigen::Vector3d& ray) { return std::max(left(ray), right(ray)); };
  const Values on_edge = values_at(honv_planes(scene::see(41, 41, roof), 1), 20, 20);
  EXPECT_GT(on_edge[0] + on_edge[4], 60);  // right
  EXPECT_GT(on_edge[2] + on_edge[6], 60);  // left
  const auto apart = [&](const Eigen::Vector3d& ray) { return ray.x() <= 0.0 ? left(ray) : right(ray) + 0.2; };
  const Values beside_step = values_at(honv_planes(scene::see(41, 41, apart), 1), 20, 20);
  EXPECT_EQ(beside_step[0] + beside_step[4], 0);
  EXPECT_NEAR(beside_step[2] + beside_step[6], 255, 2);
}

TEST(SurfaceHonv, EveryNormalCountsAsOneAndMissingOnesAsNone) {
  WorkingFrame frame = scene::ball_on_table();
  scene::add_noise(frame, 0.002, 2);
  frame.filled_depth.colRange(115, 140).setTo(scene::kNone);
  frame.filled_depth.at<float>(60, 80) = scene::kNone;
  const std::vector<cv::Mat> planes = honv_planes(frame, 1);
  for (const int x : {80, 115, 125}) EXPECT_EQ(values_at(planes, x, 60), Values(HonvLayout::kPlanes, 0)) << x;
  for (int y = 0; y < frame.filled_depth.rows; ++y) {
    int sum = 0;
    for (const int value : values_at(planes, 77, y)) sum += value;
    EXPECT_NEAR(sum, 255, 0.5 * HonvLayout::kPlanes) << y;
  }
}

TEST(SurfaceHonv, AnyNumberOfThreadsGivesTheSamePlanes) {
  WorkingFrame frame = scene::ball_on_table();
  scene::add_noise(frame, 0.002, 2);
  EXPECT_TRUE(scene::same_planes(honv_planes(frame, 1), honv_planes(frame, 3)));
}

}  // namespace
}  // namespace houghstream::baseline
