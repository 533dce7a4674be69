#include "tools/view/view_window.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <opencv2/highgui.hpp>
#include <string>

#include "pipeline/checks.hpp"
#include "tools/view/view_outputs.hpp"

namespace houghstream {
namespace {

const std::string kTitle = "Houghstream";

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

}  // namespace

ViewWindow::ViewWindow() {
  require(is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"),
          "no display for a window (DISPLAY is not set); without one use --snapshot FILE.png, --video FILE.mp4, "
          "--pictures FOLDER or --preview");
  cv::namedWindow(kTitle, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
}

void ViewWindow::show(const cv::Mat& picture, std::int64_t utime) {
  shown_ = picture;
  utime_ = utime;
  cv::imshow(kTitle, picture);
}

KeyAction ViewWindow::handle_keys(FrameViewSettings& settings) {
  constexpr int kMoment = 5;  // milliseconds
  const int key = cv::waitKey(kMoment);
  if (key == 's') save();
  const KeyAction action = apply_key(key, settings);
  return cv::getWindowProperty(kTitle, cv::WND_PROP_VISIBLE) >= 1.0 ? action : KeyAction::kEnd;
}

void ViewWindow::save() const {
  if (shown_.empty()) return;
  const std::string file = fmt::format("view_{}.png", utime_);
  write_picture(file, shown_);
  spdlog::info("saved {}", file);
}

}  // namespace houghstream
