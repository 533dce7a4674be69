#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "tools/view/frame_view.hpp"

namespace houghstream {

/// The window and its keys: q or Esc ends, space pauses, d shows or hides depth, s saves the picture.
class ViewWindow {
 public:
  /// Throws InputError, naming the headless options, where there is no display.
  ViewWindow();

  /// Shows a picture unless paused.
  void show(const cv::Mat& picture, std::int64_t utime);

  /// Lets the window live for a moment and acts on keys. False when it was asked to end.
  bool handle_keys(FrameViewSettings& settings);

 private:
  void save() const;

  cv::Mat shown_;
  std::int64_t utime_ = 0;
  bool paused_ = false;
};

}  // namespace houghstream
