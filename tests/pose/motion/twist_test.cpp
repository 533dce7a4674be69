#include "pose/motion/twist.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

Eigen::Isometry3d pose_of(double x, double angle_rad) {
  return Eigen::Translation3d(x, 0.2, 0.3) * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 3).normalized());
}

TEST(Twist, AboutTheWorldsAxesItLeadsThereAndPartOfTheWay) {
  const Eigen::Isometry3d from = pose_of(0.1, 0.5);
  const Eigen::Isometry3d to = pose_of(-0.4, 2.9);
  EXPECT_TRUE(retract_about_world(from, local_coordinates_about_world(to, from)).isApprox(to, 1e-12));
  EXPECT_TRUE(interpolate_pose(from, to, 0.0).isApprox(from, 1e-12));
  EXPECT_TRUE(interpolate_pose(from, to, 1.0).isApprox(to, 1e-12));
  const Eigen::Isometry3d quarter = interpolate_pose(from, to, 0.25);
  EXPECT_NEAR(local_coordinates_about_world(quarter, from).tail<3>().norm(), 0.25 * 2.4, 1e-9);
}

TEST(Twist, AboutTheBodyItLeadsThereAndTheProductIsARotation) {
  const Eigen::Isometry3d from = pose_of(0.1, 0.5);
  const Eigen::Isometry3d to = pose_of(-0.4, 2.9);
  const Vector6 twist = local_coordinates_about_body(from.inverse() * to);
  EXPECT_TRUE(retract_about_body(from, twist).isApprox(to, 1e-12));
  Eigen::Isometry3d crooked = from;
  crooked.linear() *= 1.001;
  const Eigen::Matrix3d R = retract_about_body(crooked, twist).linear();
  EXPECT_TRUE((R * R.transpose()).isIdentity(1e-12));
}

TEST(Twist, AboutAPointShiftAndRotationComeBack) {
  const Eigen::Isometry3d from = pose_of(0.1, 0.3);
  const Eigen::Vector3d shift(0.01, -0.02, 0.03);
  const Eigen::Vector3d rotation(0.1, 0.2, -0.05);
  const Eigen::Isometry3d to = retract_about_point(from, shift, rotation);
  EXPECT_LT((to.translation() - from.translation() - shift).norm(), 1e-12);
  EXPECT_LT((rotation_vector(to.linear() * from.linear().transpose()) - rotation).norm(), 1e-12);
  EXPECT_TRUE(retract_about_point(from, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()).isApprox(from));
}

TEST(Twist, TheConventionsDifferInTheAxesAlone) {
  const Eigen::Isometry3d from = pose_of(0.1, 0.5);
  Vector6 twist;
  twist << 0.01, -0.02, 0.03, 0.1, 0.2, -0.05;
  const Eigen::Isometry3d about_world = retract_about_world(from, twist);
  EXPECT_TRUE(retract_about_point(from, twist.head<3>(), twist.tail<3>()).isApprox(about_world, 1e-12));
  Vector6 in_body;
  in_body << from.linear().transpose() * twist.head<3>(), from.linear().transpose() * twist.tail<3>();
  EXPECT_TRUE(retract_about_body(from, in_body).isApprox(about_world, 1e-12));
  EXPECT_FALSE(retract_about_body(from, twist).isApprox(about_world, 1e-3));
}

}  // namespace
}  // namespace houghstream
