#include "pose/following/follow.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

TEST(FollowObjects, AnObjectWithoutAModelHasAReasonAndNoResidual) {
  const PoseEstimator estimator({{"box", cereal_box()}}, PoseSettings());
  ExpectedObject mug;
  mug.class_id = 2;
  mug.class_name = "mug";
  mug.score = 0.5F;
  mug.initial_poses = {standing(0.0, 30.0, 1.0)};
  const Mesh box = cereal_box();
  const RgbdFrame frame = noisy_frame({{&box, mug.initial_poses.front(), 1}}, 1);
  const std::vector<FollowedPose> followed = follow_objects(estimator, {}, frame, {mug});
  ASSERT_EQ(followed.size(), 1U);
  EXPECT_EQ(followed[0].pose.status, PoseStatus::kNoModel);
  EXPECT_EQ(followed[0].pose.class_name, "mug");
  EXPECT_TRUE(std::isnan(followed[0].pose.residual));
  EXPECT_FALSE(followed[0].pose.T_camera_object.has_value());
  EXPECT_TRUE(followed[0].T_camera_object.isApprox(mug.initial_poses.front()));
}

/// A box that was followed in one frame and is expected in another one, with what the first one showed.
struct BoxInTwoFrames {
  PoseEstimator estimator{{{"box", cereal_box()}}, PoseSettings()};
  Mesh box = cereal_box();
  ExpectedObject expected;
  FollowedPose first;

  BoxInTwoFrames() {
    expected.class_name = "box";
    expected.score = 0.9F;
    expected.initial_poses = {standing(0.0, 30.0, 1.0)};
    first = follow(1);
    expected.verified = first.verified;
    expected.colours = first.colours;
  }

  FollowedPose follow(std::uint64_t seed) {
    return follow_objects(estimator, {}, noisy_frame({{&box, standing(0.0, 30.0, 1.0), 1}}, seed), {expected}).front();
  }
};

TEST(FollowObjects, WhatStandsIsJudgedByTheColoursThatItHadBefore) {
  BoxInTwoFrames two;
  ASSERT_TRUE(two.first.pose.T_camera_object.has_value());
  ASSERT_TRUE(two.first.colours.has_value());
  EXPECT_EQ(two.first.colours->T_camera_object.matrix(), two.first.T_camera_object.matrix());
  const FollowedPose second = two.follow(2);
  ASSERT_TRUE(second.pose.T_camera_object.has_value());
  EXPECT_NE(second.T_camera_object.matrix(), two.first.T_camera_object.matrix());  // noise moves it a little
  EXPECT_EQ(second.colours->T_camera_object.matrix(), two.first.T_camera_object.matrix());
}

TEST(FollowObjects, WhatHasMovedOrWasRenderedAnewIsComparedWithItsColoursAnew) {
  BoxInTwoFrames moved;
  moved.expected.colours->T_camera_object.pretranslate(Eigen::Vector3d(0.003, 0.0, 0.0));
  const FollowedPose second = moved.follow(2);
  EXPECT_EQ(second.colours->T_camera_object.matrix(), second.T_camera_object.matrix());
  BoxInTwoFrames turned;
  turned.expected.colours->T_camera_object.rotate(Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitZ()));
  const FollowedPose third = turned.follow(2);
  EXPECT_EQ(third.colours->T_camera_object.matrix(), third.T_camera_object.matrix());
  BoxInTwoFrames rendered;
  rendered.expected.verified.reset();
  const FollowedPose fourth = rendered.follow(2);
  EXPECT_EQ(fourth.colours->T_camera_object.matrix(), fourth.T_camera_object.matrix());
}

}  // namespace
}  // namespace houghstream
