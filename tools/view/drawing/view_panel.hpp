#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tools/view/drawing/frame_view.hpp"

namespace houghstream::view {

/// Which frame is shown, and of which camera: "LEFT_CAMERA (1 of 2), frame 1499876543.210 s".
std::string camera_heading(const FrameId& frame, const std::vector<std::string>& cameras);

/// How many objects are shown, of how many that were sent. The smallest score is hs-view's own; that of the detector,
/// below which it sends nothing, is not on the wire.
std::string objects_heading(const ViewedFrame& viewed, float min_score);

/// Four blocks of text and charts below the pictures: the stream's rates and losses, the objects of the frame, the
/// times of its stages, and the latency of the last frames. They stand side by side as far as `width` pixels allow,
/// the others below. With `settings.show_keys` a line that names the keys follows.
cv::Mat draw_panel(const ViewedFrame& viewed, const StreamView& stream, const FrameViewSettings& settings, int width);

}  // namespace houghstream::view
