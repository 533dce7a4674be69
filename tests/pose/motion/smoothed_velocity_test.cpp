#include "pose/motion/smoothed_velocity.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace houghstream {
namespace {

const Eigen::Isometry3d kStart(Eigen::Translation3d(0.1, 0.0, 1.0) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()));

TEST(SmoothedVelocity, GoesOnAtTheVelocityOfTheLastStepsAndStandsAfterAReset) {
  const Eigen::Isometry3d step(Eigen::Translation3d(0.01, -0.02, 0.03));
  SmoothedVelocity velocity;
  EXPECT_TRUE(velocity.is_zero());
  EXPECT_TRUE(velocity.predict(kStart, 0.1).isApprox(kStart));
  velocity.update(kStart, step * kStart, 0.1, 0.5);
  EXPECT_FALSE(velocity.is_zero());
  EXPECT_LT((velocity.predict(kStart, 0.2).translation() - (step * kStart).translation()).norm(), 1e-12);
  velocity.update(kStart, step * kStart, 0.1, 0.5);
  EXPECT_LT((velocity.predict(kStart, 0.1).translation() - kStart.translation() - 0.75 * step.translation()).norm(),
            1e-12);
  velocity.reset();
  EXPECT_TRUE(velocity.is_zero());
}

TEST(SmoothedVelocity, TurnsAboutTheObjectsOrigin) {
  const Eigen::AngleAxisd rotation(0.1, Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d rotated = kStart;
  rotated.linear() = rotation * kStart.linear();
  SmoothedVelocity velocity;
  velocity.update(kStart, rotated, 0.1, 1.0);
  EXPECT_TRUE(velocity.predict(kStart, 0.1).isApprox(rotated, 1e-12));
}

TEST(SmoothedVelocity, ATurnThatIsNotObservedIsNotPredicted) {
  const Eigen::AngleAxisd rotation(0.1, Eigen::Vector3d(1.0, 0.0, 1.0).normalized());
  Eigen::Isometry3d rotated = Eigen::Translation3d(0.01, 0.0, 0.0) * kStart;
  rotated.linear() = rotation * kStart.linear();
  SmoothedVelocity velocity;
  velocity.update(kStart, rotated, 0.1, 1.0);
  velocity.limit_rotation(Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal());
  const Eigen::Isometry3d next = velocity.predict(kStart, 0.1);
  EXPECT_TRUE(next.translation().isApprox(rotated.translation(), 1e-12));
  const Eigen::AngleAxisd left(next.linear() * kStart.linear().transpose());
  EXPECT_NEAR(left.angle(), 0.1 / std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(left.axis().x(), 1.0, 1e-9);
}

TEST(SmoothedVelocity, TheMotionThatTwoAgreeOnCarriesTheRestAndOneAloneDoesNot) {
  const Eigen::Isometry3d camera(Eigen::Translation3d(0.05, 0.0, 0.0));
  const Eigen::Isometry3d nearly(Eigen::Translation3d(0.052, 0.001, 0.0));
  const Eigen::Isometry3d pushed(Eigen::Translation3d(0.0, 0.2, 0.0));
  EXPECT_FALSE(predict_by_camera_motion(kStart, {}).has_value());
  EXPECT_FALSE(predict_by_camera_motion(kStart, {camera}).has_value());
  EXPECT_FALSE(predict_by_camera_motion(kStart, {camera, pushed}).has_value());
  const std::optional<Eigen::Isometry3d> carried = predict_by_camera_motion(kStart, {pushed, camera, nearly});
  ASSERT_TRUE(carried.has_value());
  EXPECT_TRUE(carried->isApprox(camera * kStart));
}

}  // namespace
}  // namespace houghstream
