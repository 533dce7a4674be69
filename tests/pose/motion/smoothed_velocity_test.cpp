#include "pose/motion/smoothed_velocity.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

const Eigen::Isometry3d kPose(Eigen::Translation3d(0.1, 0.0, 1.0) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));

TEST(Motion, ShiftAndTurnComeBack) {
  const Eigen::Vector3d shift(0.01, -0.02, 0.03);
  const Eigen::Vector3d turn(0.1, 0.2, -0.05);
  const Eigen::Isometry3d moved = moved_on(kPose, shift, turn);
  EXPECT_LT((moved.translation() - kPose.translation() - shift).norm(), 1e-12);
  EXPECT_LT((turn_of(moved.linear() * kPose.linear().transpose()) - turn).norm(), 1e-12);
  EXPECT_TRUE(moved_on(kPose, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()).isApprox(kPose));
}

TEST(Motion, TheMotionThatTwoAgreeOnCarriesTheRestAndOneAloneDoesNot) {
  const Eigen::Isometry3d camera(Eigen::Translation3d(0.05, 0.0, 0.0));
  const Eigen::Isometry3d nearly(Eigen::Translation3d(0.052, 0.001, 0.0));
  const Eigen::Isometry3d pushed(Eigen::Translation3d(0.0, 0.2, 0.0));
  EXPECT_FALSE(carried_along(kPose, {}).has_value());
  EXPECT_FALSE(carried_along(kPose, {camera}).has_value());
  EXPECT_FALSE(carried_along(kPose, {camera, pushed}).has_value());
  const std::optional<Eigen::Isometry3d> carried = carried_along(kPose, {pushed, camera, nearly});
  ASSERT_TRUE(carried.has_value());
  EXPECT_TRUE(carried->isApprox(camera * kPose));
}

}  // namespace
}  // namespace houghstream
