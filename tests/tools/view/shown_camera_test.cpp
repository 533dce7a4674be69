#include "tools/view/shown_camera.hpp"

#include <gtest/gtest.h>

namespace houghstream::view {
namespace {

TEST(ShownCamera, TheFirstIsShownUntilAnotherIsAskedFor) {
  ShownCamera cameras;
  EXPECT_TRUE(cameras.is_shown("ANY"));
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
}  // namespace houghstream::view
