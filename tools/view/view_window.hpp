#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "pipeline/types/frame_id.hpp"
#include "tools/view/drawing/frame_view.hpp"

namespace houghstream::view {

/// What a key asks for.
enum class KeyAction {
  kNone,
  kRedraw,      ///< the settings have changed
  kNextCamera,  ///< the next camera's frames are to be shown
  kTeach,       ///< what is seen is to be taught, or enough of it was shown
  kEnd,
};

/// What a key, as cv::waitKey gives it, does to the settings: q or Esc ends, space pauses, d shows or hides depth, 3
/// shows 3-D in its place, w the world from above, + and - move the smallest score that is drawn, c goes on to the next
/// camera, t teaches.
KeyAction apply_key(int key, FrameViewSettings& settings);

/// What the mouse marks, pressed at one corner of `dragged` and by now at another: a box, or a place, where it hardly
/// moved.
void apply_mark(const cv::Rect& dragged, FrameViewSettings& settings);

/// The window; its keys are those of apply_key, and s, which saves the image; where that fails it is logged.
class ViewWindow {
 public:
  /// Throws InputError, naming the headless options, where there is no display.
  ViewWindow();

  void show(const cv::Mat& image, const FrameId& id);

  /// Lets the window live for a moment and acts on keys and on the mouse, which marks a box or a place (apply_mark).
  KeyAction handle_keys(FrameViewSettings& settings);

 private:
  static void on_mouse(int event, int x, int y, int flags, void* window);
  void save() const;

  cv::Mat shown_;
  FrameId id_;
  double scale_ = 1.0;                // of what the window shows; below 1 for an image that no window holds
  std::optional<cv::Point> pressed_;  // where the mouse's button went down
  std::optional<cv::Rect> dragged_;   // from there to where it is or went up; not yet handed on
};

}  // namespace houghstream::view
