#include "pipeline/bus/channel_pattern.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

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

TEST(ChannelPattern, ANameMayHaveAnyBytesAndAnyLength) {
  const ChannelPattern any("CAMERA.*");
  EXPECT_TRUE(any.matches("CAMERA\xC3\xA9")) << "a letter of UTF-8";
  EXPECT_TRUE(any.matches("CAMERA\xFF")) << "no UTF-8";
  EXPECT_TRUE(any.matches("CAMERA" + std::string(8'000'000, '_'))) << "and the stack is not used up";
  EXPECT_FALSE(ChannelPattern("CAMERA_*").matches("CAMERA" + std::string(8'000'000, '_') + "2"));
}

// Tried one after another, the ways to distribute these letters among those stars would take longer than the test may.
TEST(ChannelPattern, AnExpressionOfManyWaysIsMatchedAtOnce) {
  std::string many;
  for (int i = 0; i < 100; ++i) many += "a*";
  const ChannelPattern pattern(many + "b");
  EXPECT_FALSE(pattern.matches(std::string(60, 'a')));
  EXPECT_TRUE(pattern.matches(std::string(60, 'a') + "b"));
  EXPECT_FALSE(ChannelPattern("(a*)*b").matches(std::string(60, 'a')));
}

TEST(ChannelPattern, WhatIsNoExpressionIsRefused) {
  const std::string stars(100, '*');
  const std::string too_large = "((((x{1,9}){1,9}){1,9}){1,9}){1,9}";
  for (const std::string& bad : {std::string("("), stars, "a" + stars, std::string("(?!LEFT).*"), too_large})
    EXPECT_THROW(ChannelPattern{bad}, InputError) << bad;
}

TEST(ChannelPattern, ARefusalIsOneLine) {
  try {
    const ChannelPattern bad("LEFT(\n");
    ADD_FAILURE() << "taken";
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.rfind("channels 'LEFT(\\x0a': missing )", 0), 0U) << line;
    EXPECT_NE(line.find(", expected a regular expression"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace houghstream
