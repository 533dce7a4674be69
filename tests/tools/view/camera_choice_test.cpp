#include "tools/view/camera_choice.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(CameraChoice, TheFirstIsShownUntilAnotherIsAskedFor) {
  CameraChoice cameras;
  EXPECT_FALSE(cameras.is_shown(""));
  cameras.next();
  cameras.note("LEFT");
  cameras.note("RIGHT");
  cameras.note("ABOVE");
  EXPECT_TRUE(cameras.is_shown("LEFT"));
  EXPECT_FALSE(cameras.is_shown("RIGHT"));
  cameras.next();
  EXPECT_TRUE(cameras.is_shown("RIGHT"));
  cameras.next();
  EXPECT_TRUE(cameras.is_shown("ABOVE"));
  EXPECT_EQ(cameras.heard(), (std::vector<std::string>{"ABOVE", "LEFT", "RIGHT"}));
}

}  // namespace
}  // namespace houghstream
