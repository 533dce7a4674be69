#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "pipeline/types/frame_id.hpp"
#include "tools/view/drawing/frame_view.hpp"

namespace houghstream::view {

/// Actions of a key.
enum class KeyAction {
  kNone,
  kRedraw,      ///< the settings have changed
  kNextCamera,  ///< the next camera's frames are to be shown
  kTeach,       ///< teach the object that is shown, or end the showing
  kEnd,
};

/// Applies a key of cv::waitKey to the settings: q or Esc ends, space pauses, d shows or hides depth, 3 shows 3-D in
/// its place, w the world from above, + and - change the minimum score that is drawn, c selects the next camera, t
/// teaches.
KeyAction apply_key(int key, FrameViewSettings& settings);

/// Applies a mark of the mouse, pressed at one corner of `dragged` and now at another: a box, or a pixel where it
/// hardly moved.
void apply_mark(const cv::Rect& dragged, FrameViewSettings& settings);

/// Shows the window; its keys are those of apply_key, and s, which saves the image; a failure of that is logged.
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
  double scale_ = 1.0;                // scale of the shown image; below 1 where the image exceeds the window
  std::optional<cv::Point> pressed_;  // pixel where the mouse's button was pressed
  std::optional<cv::Rect> dragged_;   // from there to its present or last pixel; not yet handed on
};

}  // namespace houghstream::view
