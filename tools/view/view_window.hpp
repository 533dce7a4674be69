#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "pipeline/types/frame_id.hpp"
#include "tools/view/view_keys.hpp"

namespace houghstream::view {

/// The window; its keys are those of apply_key, and s, which saves the picture; where that fails it is logged.
class ViewWindow {
 public:
  /// Throws InputError, naming the headless options, where there is no display.
  ViewWindow();

  void show(const cv::Mat& picture, const FrameId& id);

  /// Lets the window live for a moment and acts on keys and on the mouse, which marks a box or a place (apply_mark).
  KeyAction handle_keys(FrameViewSettings& settings);

 private:
  static void on_mouse(int event, int x, int y, int flags, void* window);
  void save() const;

  cv::Mat shown_;
  FrameId id_;
  double scale_ = 1.0;                // of what the window shows; below 1 for a picture that no window holds
  std::optional<cv::Point> pressed_;  // where the mouse's button went down
  std::optional<cv::Rect> dragged_;   // from there to where it is or went up; not yet handed on
};

}  // namespace houghstream::view
