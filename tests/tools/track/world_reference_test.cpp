#include "tools/track/world_reference.hpp"

#include <gtest/gtest.h>

namespace houghstream::track {
namespace {

using Places = std::map<std::string, Eigen::Isometry3d>;

TEST(WorldReference, IsTheOneCamerasWhereNoPlaceIsKnown) {
  WorldReference world(Places{});
  EXPECT_TRUE(world.camera_pose({"LEFT", 1}, true).may_come);
  EXPECT_EQ(world.name(), "");
  EXPECT_TRUE(world.camera_pose({"LEFT", 1}, false).T_world_camera);
  EXPECT_EQ(world.name(), "LEFT");
  const tracks::CameraPose other = world.camera_pose({"RIGHT", 1}, false);
  EXPECT_FALSE(other.T_world_camera);
  EXPECT_FALSE(other.may_come);
  EXPECT_NE(other.reason, "");
  EXPECT_FALSE(world.consume_reset());
}

TEST(WorldReference, BeginsAnewWithTheFirstTransform) {
  WorldReference world(Places{});
  world.camera_pose({"LEFT", 1}, false);
  const Eigen::Isometry3d there(Eigen::Translation3d(1, 2, 3));
  world.add("LEFT", 2, there);
  const tracks::CameraPose place = world.camera_pose({"LEFT", 2}, true);
  ASSERT_TRUE(place.T_world_camera);
  EXPECT_TRUE(place.T_world_camera->isApprox(there));
  EXPECT_EQ(world.name(), "WORLD");
  EXPECT_TRUE(world.consume_reset());
  EXPECT_FALSE(world.consume_reset());
}

TEST(WorldReference, KnowsCamerasThatStandStill) {
  const Eigen::Isometry3d there(Eigen::Translation3d(1, 2, 3));
  WorldReference world(Places{{"left", there}});
  ASSERT_TRUE(world.camera_pose({"left", 7}, true).T_world_camera);
  EXPECT_EQ(world.name(), "WORLD");
  EXPECT_FALSE(world.consume_reset());
  EXPECT_TRUE(world.camera_pose({"RIGHT", 7}, true).may_come);
  EXPECT_FALSE(world.camera_pose({"RIGHT", 7}, false).may_come);
}

}  // namespace
}  // namespace houghstream::track
