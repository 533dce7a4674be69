#include "pipeline/bus/channel_pattern.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "pipeline/bus/channels.hpp"

namespace houghstream {
namespace {

TEST(ChannelPattern, ANameStandsForItself) {
  const ChannelPattern name("OPENNI_FRAME");
  EXPECT_TRUE(name.is_name());
  EXPECT_TRUE(name.matches("OPENNI_FRAME"));
  EXPECT_FALSE(name.matches("OPENNI_FRAME_2"));
}

TEST(ChannelPattern, AnExpressionIsForTheWholeName) {
  const ChannelPattern two("LEFT|RIGHT");
  EXPECT_FALSE(two.is_name());
  EXPECT_TRUE(two.matches("LEFT"));
  EXPECT_TRUE(two.matches("RIGHT"));
  EXPECT_FALSE(two.matches("LEFT_2"));
  EXPECT_FALSE(two.matches("UPRIGHT"));
  EXPECT_TRUE(ChannelPattern("CAMERA_[0-9]+").matches("CAMERA_17"));
}

TEST(ChannelPattern, ANameOfAnyLengthIsSurvived) {
  const ChannelPattern any("CAMERA.*");
  EXPECT_TRUE(any.matches("CAMERA" + std::string(channel::kMostBytes - 6, '_')));
  EXPECT_FALSE(any.matches("CAMERA" + std::string(channel::kMostBytes - 5, '_')));
  EXPECT_FALSE(any.matches("CAMERA" + std::string(8'000'000, '_'))) << "and the stack is not used up";
}

TEST(ChannelPattern, WhatIsNoExpressionIsRefused) {
  EXPECT_THROW(ChannelPattern("("), InputError);
}

}  // namespace
}  // namespace houghstream
