#include "tools/view/view_window.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::view {
namespace {

std::string refusal(const char* display) {
  unsetenv("WAYLAND_DISPLAY");
  setenv("DISPLAY", display, 1);
  return error_of([&] { const ViewWindow window; });
}

// Its content and its keys are tested on a real display by live_images_test.
TEST(ViewWindow, WithoutADisplayTheWaysToGoOnAreNamed) {
  for (const char* display : {"", ":9999"}) {
    const std::string words = refusal(display);
    EXPECT_NE(words.find("no display"), std::string::npos) << words;
    for (const char* way : {"--snapshot", "--video", "--pictures", "--preview", "--http"}) {
      EXPECT_NE(words.find(way), std::string::npos) << words;
    }
  }
}

TEST(ViewKeys, EachKeyDoesWhatTheWindowSays) {
  FrameViewSettings settings;
  EXPECT_EQ(apply_key('d', settings), KeyAction::kRedraw);
  EXPECT_FALSE(settings.show_depth);
  EXPECT_EQ(apply_key('3', settings), KeyAction::kRedraw);
  EXPECT_TRUE(settings.show_3d);
  EXPECT_EQ(apply_key(' ', settings), KeyAction::kRedraw);
  EXPECT_TRUE(settings.paused);
  apply_key(' ', settings);
  EXPECT_FALSE(settings.paused);
  EXPECT_EQ(apply_key('c', settings), KeyAction::kNextCamera);
  EXPECT_EQ(apply_key('t', settings), KeyAction::kTeach);
  EXPECT_EQ(apply_key('q', settings), KeyAction::kEnd);
  EXPECT_EQ(apply_key(27, settings), KeyAction::kEnd);
  EXPECT_EQ(apply_key(-1, settings), KeyAction::kNone);
  EXPECT_EQ(apply_key('x', settings), KeyAction::kNone);
}

TEST(ViewKeys, TheMouseMarksABoxOrByAClickAPlace) {
  FrameViewSettings settings;
  apply_mark({10, 20, 0, 0}, settings);
  EXPECT_EQ(settings.at, cv::Point(10, 20));
  EXPECT_TRUE(settings.box.empty());
  apply_mark({10, 20, 50, 60}, settings);
  EXPECT_FALSE(settings.at.has_value());
  EXPECT_EQ(settings.box, cv::Rect(10, 20, 50, 60));
  apply_mark({30, 30, 3, 3}, settings);
  EXPECT_EQ(settings.at, cv::Point(30, 30)) << "no hand is quite still";
  EXPECT_TRUE(settings.box.empty());
}

TEST(ViewKeys, TheThresholdStaysBetweenZeroAndOne) {
  FrameViewSettings settings;
  settings.min_score = 0.5F;
  EXPECT_EQ(apply_key('+', settings), KeyAction::kRedraw);
  EXPECT_NEAR(settings.min_score, 0.55F, 1e-6);
  for (int i = 0; i < 30; ++i) apply_key('+', settings);
  EXPECT_EQ(settings.min_score, 1.0F);
  for (int i = 0; i < 30; ++i) apply_key('-', settings);
  EXPECT_EQ(settings.min_score, 0.0F);
}

}  // namespace

}  // namespace houghstream::view
