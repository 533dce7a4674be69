#include "pipeline/bus/channels.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(Channels, ObjectsHaveTransformChannels) {
  EXPECT_EQ(channel::to_camera("cereal_box"), "CEREAL_BOX_TO_CAMERA");
  EXPECT_EQ(channel::to_camera("can-2 red"), "CAN_2_RED_TO_CAMERA");
  EXPECT_EQ(channel::to_camera(std::string(100, 'x')).size(), 63U);
}

}  // namespace
}  // namespace houghstream
