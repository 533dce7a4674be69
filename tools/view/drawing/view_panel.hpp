#pragma once

#include <opencv2/core.hpp>

#include "tools/view/drawing/frame_view.hpp"

namespace houghstream {

/// Four blocks of text and charts below the pictures: the stream's rates and losses, the objects of the frame, the
/// times of its stages, and the latency of the last frames. They stand side by side as far as `width` pixels allow,
/// the others below. With `settings.show_keys` a line that names the keys follows.
cv::Mat draw_panel(const ViewedFrame& viewed, const StreamView& stream, const FrameViewSettings& settings, int width);

}  // namespace houghstream
