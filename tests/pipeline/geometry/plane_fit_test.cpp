#include "pipeline/geometry/plane_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace houghstream {
namespace {

constexpr double kLimit_m = 0.005;

double within_limit(const Eigen::Vector3d& /*point*/) {
  return kLimit_m;
}

/// Returns points of a plane 0.8 m before a camera, two thirds of all, and others anywhere in front of it.
std::vector<Eigen::Vector3d> table_and_clutter(const Plane& plane, int count) {
  Random random(7);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d anywhere(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(0.5, 1.1));
    const Eigen::Vector3d noise = random.uniform(-0.002, 0.002) * plane.normal();
    points.push_back(i % 3 == 0 ? anywhere : Eigen::Vector3d(plane.projection(anywhere) + noise));
  }
  return points;
}

TEST(PlaneFit, TheLargestPlaneIsFoundAmongOtherPoints) {
  const Plane truth(Eigen::Vector3d(0.1, -0.6, -0.8).normalized(), 0.8);
  const std::vector<Eigen::Vector3d> points = table_and_clutter(truth, 600);
  Random random(1);
  const std::optional<Plane> found = find_largest_plane(points, within_limit, {}, random);
  ASSERT_TRUE(found.has_value());
  const Plane fitted = fit_plane(points_on(*found, points, within_limit), [](const Eigen::Vector3d&) { return 1.0; });
  EXPECT_GT(fitted.normal().dot(truth.normal()), std::cos(0.01)) << "towards the camera too";
  EXPECT_NEAR(fitted.offset(), truth.offset(), 0.002);
}

TEST(PlaneFit, PointsOfNoWeightMoveNoPlane) {
  const Plane truth(-Eigen::Vector3d::UnitZ(), 0.8);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 30; ++i) points.emplace_back(0.01 * (i % 6), 0.01 * (i / 6), 0.8);
  points.emplace_back(0.3, 0.3, 1.5);
  const Plane fitted = fit_plane(points, [](const Eigen::Vector3d& point) { return point.z() > 1.0 ? 0.0 : 1.0; });
  EXPECT_LT((fitted.normal() - truth.normal()).norm(), 1e-9);
  EXPECT_NEAR(fitted.offset(), truth.offset(), 1e-9);
}

TEST(PlaneFit, PointsOfOneLineDefineNone) {
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 20; ++i) line.emplace_back(0.01 * i, 0.0, 1.0);
  Random random(1);
  EXPECT_FALSE(find_largest_plane(line, within_limit, {}, random).has_value());
}

}  // namespace
}  // namespace houghstream
