#include "tools/train/turntable.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

/// Returns the pose of an upright object frame whose origin is at `t`, seen from `elevation` radians above.
Eigen::Isometry3d axis_pose(double elevation, const Eigen::Vector3d& t) {
  Eigen::Isometry3d T_camera_axis = Eigen::Isometry3d::Identity();
  T_camera_axis.linear() = Eigen::AngleAxisd(M_PI / 2 + elevation, Eigen::Vector3d::UnitX()).toRotationMatrix();
  T_camera_axis.translation() = t;
  return T_camera_axis;
}

/// Points that a camera sees of a box of 8 x 5 x 12 cm off the axis, with a colour per side, at 1 mm noise.
std::vector<ColouredPoint> see_box(const Eigen::Isometry3d& T_camera_object, Random& random) {
  const Eigen::Vector3d half(0.04, 0.025, 0.06);
  const Eigen::Vector3d beside(0.01, -0.005, 0.0);
  std::vector<ColouredPoint> points;
  for (int n = 0; n < 3000; ++n) {
    const int axis = random.below(3);
    const double side = random.below(2) == 0 ? -1.0 : 1.0;
    Eigen::Vector3d p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    p[axis] = side;
    const Eigen::Vector3d normal = T_camera_object.linear() * Eigen::Vector3d::Unit(axis) * side;
    const Eigen::Vector3d position = T_camera_object * (p.cwiseProduct(half) + beside);
    if (normal.dot(position) >= 0.0) continue;
    const int level = 40 * (2 * axis + (side > 0 ? 1 : 0));
    const Eigen::Vector3d noise(0.0, 0.0, 0.001 * random.normal());
    points.push_back({position + noise, cv::Vec3b::all(static_cast<std::uint8_t>(level))});
  }
  return points;
}

std::vector<TurntableView> rotate_box(double elevation, double direction, const Eigen::Vector3d& t) {
  Random random(11);
  std::vector<TurntableView> views;
  for (int i = 0; i < 36; ++i) {
    const double yaw = 2.0 * M_PI * i / 36;
    const Eigen::Isometry3d rotated =
        axis_pose(elevation, t) * Eigen::AngleAxisd(direction * yaw, Eigen::Vector3d::UnitZ());
    views.push_back({yaw, see_box(rotated, random)});
  }
  return views;
}

void expect_found(double elevation, double direction) {
  const Eigen::Vector3d t(0.05, -0.03, 0.7);
  const Turntable table = estimate_turntable(rotate_box(elevation, direction, t));
  EXPECT_EQ(table.direction, direction);
  const Eigen::Isometry3d truth = axis_pose(elevation, t);
  const double tilt = std::acos(table.T_camera_axis.linear().col(2).dot(truth.linear().col(2)));
  EXPECT_LT(tilt, 3.0 * M_PI / 180.0) << "elevation " << elevation << " direction " << direction;
  EXPECT_LT((table.T_camera_axis.translation() - t).norm(), 0.005) << "elevation " << elevation;
  EXPECT_TRUE(table.pose_at(0.0).isApprox(table.T_camera_axis));
}

TEST(Turntable, AxisElevationAndDirectionAreFound) {
  expect_found(0.0, 1.0);
  expect_found(0.5, -1.0);
  expect_found(0.8, 1.0);
}

TEST(Turntable, ViewsWithoutPointsAreIgnored) {
  std::vector<TurntableView> views = rotate_box(0.5, 1.0, {0.0, 0.0, 0.7});
  views[3].points.clear();
  EXPECT_LT((estimate_turntable(views).T_camera_axis.translation() - Eigen::Vector3d(0.0, 0.0, 0.7)).norm(), 0.005);
}

TEST(Turntable, NothingSeenIsRefused) {
  EXPECT_THROW(estimate_turntable({}), InputError);
  EXPECT_THROW(estimate_turntable({TurntableView{}, TurntableView{}}), InputError);
}

}  // namespace
}  // namespace houghstream
