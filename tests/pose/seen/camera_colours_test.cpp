#include "pose/seen/camera_colours.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

const Eigen::Vector2d kWarm(6.0, 18.0);
const Eigen::Vector2d kCold(-3.0, -20.0);

/// Returns a sure pose of an object, whose colours the camera shifts.
ObjectPose confirmed(const std::string& name, const Eigen::Vector2d& model, const Eigen::Vector2d& shift) {
  ObjectPose pose;
  pose.class_name = name;
  pose.status = PoseStatus::kValid;
  pose.quality = 0.95F;
  pose.T_camera_object = Eigen::Isometry3d::Identity();
  ChromaPair& pair = pose.chroma.emplace();
  pair.class_name = name;
  pair.model = model;
  pair.measured = model + shift;
  pair.lightness = 60.0;
  pair.probability = 0.9;
  return pose;
}

ObjectPoses four_objects(const Eigen::Vector2d& shift) {
  ObjectPoses poses;
  poses.poses = {confirmed("cracker", {30.0, 20.0}, shift), confirmed("soup", {-5.0, 10.0}, shift),
                 confirmed("sugar", {5.0, 30.0}, shift), confirmed("meat", {-10.0, -15.0}, shift)};
  return poses;
}

Eigen::Vector2d shift_of(const ChromaMap& map) {
  return map.apply({5.0, 10.0}, 60.0) - Eigen::Vector2d(5.0, 10.0);
}

TEST(CameraColours, WithoutAConfirmedPoseNothingIsLearnt) {
  CameraColours colours;
  ObjectPoses poses = four_objects(kWarm);
  poses.poses[0].quality = 0.5F;
  poses.poses[1].status = PoseStatus::kRejectedByColour;
  poses.poses[2].chroma.reset();
  poses.poses.pop_back();
  colours.update(poses);
  EXPECT_TRUE(colours.pairs().empty());
  EXPECT_FALSE(colours.map().is_learnt());
}

TEST(CameraColours, AnObjectIsJudgedByTheOtherClasses) {
  CameraColours colours;
  for (int frame = 0; frame < 10; ++frame) colours.update(four_objects(kWarm));
  EXPECT_EQ(colours.pairs().size(), 4U) << "each class is remembered once, however often it was seen";
  EXPECT_LT((shift_of(colours.map()) - kWarm).norm(), 7.5);
  EXPECT_NEAR(colours.map_without("soup").objects(), 3.0, 0.3);
  EXPECT_NEAR(colours.map_without("drill").objects(), 4.0, 0.4);
}

TEST(CameraColours, ALightThatJumpsIsLearntAnew) {
  CameraColours colours;
  for (int frame = 0; frame < 10; ++frame) colours.update(four_objects(kWarm));
  colours.update(four_objects(kCold));
  EXPECT_LT((shift_of(colours.map()) - kWarm).norm(), 7.5) << "a single frame may be wrong";
  colours.update(four_objects(kCold));
  EXPECT_LT((shift_of(colours.map()) - kCold).norm(), 8.0);
}

TEST(CameraColours, ALightThatChangesSlowlyIsFollowed) {
  CameraColours colours;
  for (int frame = 0; frame <= 40; ++frame) {
    const double fraction = frame / 40.0;
    colours.update(four_objects((1.0 - fraction) * kWarm + fraction * kCold));
  }
  EXPECT_LT((shift_of(colours.map()) - kCold).norm(), 10.0);
}

TEST(CameraColours, OneObjectOfOtherColoursIsNoJump) {
  CameraColours colours;
  for (int frame = 0; frame < 10; ++frame) colours.update(four_objects(kWarm));
  ObjectPoses poses = four_objects(kWarm);
  poses.poses[0].chroma->measured = {-40.0, -40.0};
  for (int frame = 0; frame < 3; ++frame) colours.update(poses);
  EXPECT_LT((shift_of(colours.map()) - kWarm).norm(), 8.5);
}

TEST(CameraColours, AnotherSideOfAnObjectIsNoJump) {
  CameraColours colours;
  for (int frame = 0; frame < 10; ++frame) colours.update(four_objects(kWarm));
  ObjectPoses rotated;
  rotated.poses = {confirmed("cracker", {-10.0, 40.0}, kWarm), confirmed("soup", {20.0, -10.0}, kWarm)};
  for (int frame = 0; frame < 2; ++frame) colours.update(rotated);
  EXPECT_EQ(colours.pairs().size(), 4U);
}

}  // namespace
}  // namespace houghstream
