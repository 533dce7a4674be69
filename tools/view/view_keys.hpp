#pragma once

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

}  // namespace houghstream::view
