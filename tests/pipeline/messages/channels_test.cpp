#include "pipeline/messages/channels.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

TEST(Channels, ObjectsHaveTransformChannels) {
  EXPECT_EQ(channel::to_camera("cereal_box"), "CEREAL_BOX_TO_CAMERA");
  EXPECT_EQ(channel::to_camera("can-2 red"), "CAN_2_RED_TO_CAMERA");
  EXPECT_EQ(channel::to_camera(std::string(100, 'x')).size(), 63U);
}

TEST(Channels, ObjectsOfTheWorldHavePoseChannels) {
  EXPECT_EQ(channel::object_pose("cereal_box", 3), "CEREAL_BOX_3_POSE");
  EXPECT_EQ(channel::object_pose(std::string(100, 'x'), 12).size(), 63U);
  EXPECT_EQ(channel::frame_pose("cereal_box", 3, "lid.top"), "CEREAL_BOX_3_LID_TOP_POSE");
  EXPECT_EQ(channel::frame_pose(std::string(100, 'x'), 12, std::string(100, 'y')).size(), 63U);
}

TEST(Channels, NamesThatLcmDoesNotSendAreRefused) {
  EXPECT_NO_THROW(channel::require_name("X"));
  EXPECT_NO_THROW(channel::require_name(std::string(63, 'x')));
  EXPECT_THROW(channel::require_name(""), InputError);
  EXPECT_THROW(channel::require_name(std::string(64, 'x')), InputError);
}

TEST(Channels, ATransformSaysWhichCameraWhereThereAreSeveral) {
  EXPECT_EQ(channel::to_camera("mug", "LEFT_CAMERA"), "MUG_TO_LEFT_CAMERA");
  EXPECT_EQ(channel::to_camera("mug", "left-cam.2"), "MUG_TO_LEFT_CAM_2");
  const std::string left = channel::to_camera(std::string(100, 'x'), std::string(50, 'y') + "_LEFT");
  const std::string right = channel::to_camera(std::string(100, 'x'), std::string(50, 'y') + "_RIGHT");
  EXPECT_EQ(left.size(), 63U);
  EXPECT_NE(left, right);
}

}  // namespace
}  // namespace houghstream
