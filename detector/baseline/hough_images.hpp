#pragma once

#include <opencv2/core.hpp>

#include "detector/stages.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream::baseline {

/// Returns the Hough space of one class as an image (paper, Figure 3): CV_32FC1 of the frame's size, the vote mass that
/// meets around each pixel as a share of what a wholly visible object is expected to have. Of a scale space, the
/// largest over all sizes; of a depth-normalised forest only about, since votes of all distances are smoothed alike.
cv::Mat hough_image(const SearchContext& search, int class_index, const RgbdFrame& frame);

}  // namespace houghstream::baseline
