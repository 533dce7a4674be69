#include "tools/view/view_window.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "pipeline/base/checks.hpp"

namespace houghstream::view {
namespace {

std::string refusal(const char* display) {
  unsetenv("WAYLAND_DISPLAY");
  setenv("DISPLAY", display, 1);
  try {
    const ViewWindow window;
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// What it shows and which keys it takes is tried on a real display by live_pictures_test.
TEST(ViewWindow, WithoutADisplayTheWaysToGoOnAreNamed) {
  for (const char* display : {"", ":9999"}) {
    const std::string words = refusal(display);
    EXPECT_NE(words.find("no display"), std::string::npos) << words;
    for (const char* way : {"--snapshot", "--video", "--pictures", "--preview", "--http"}) {
      EXPECT_NE(words.find(way), std::string::npos) << words;
    }
  }
}

}  // namespace
}  // namespace houghstream::view
