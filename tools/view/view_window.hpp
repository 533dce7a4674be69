#pragma once

#include <opencv2/core.hpp>

#include "pipeline/types/frame_id.hpp"
#include "tools/view/view_keys.hpp"

namespace houghstream::view {

/// The window; its keys are those of apply_key, and s, which saves the picture.
class ViewWindow {
 public:
  /// Throws InputError, naming the headless options, where there is no display.
  ViewWindow();

  void show(const cv::Mat& picture, const FrameId& id);

  /// Lets the window live for a moment and acts on keys.
  KeyAction handle_keys(FrameViewSettings& settings);

 private:
  void save() const;

  cv::Mat shown_;
  FrameId id_;
};

}  // namespace houghstream::view
