#pragma once

#include <opencv2/core.hpp>

#include "detector/detector_settings.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/frame.hpp"

namespace houghstream {

/// The Hough space of one class as a picture (paper, Figure 3): CV_32FC1 of the frame's size, larger where more votes
/// for the object's centre meet. Of a scale space it is the largest share of a whole object's vote mass over all sizes,
/// otherwise the sum of smoothed votes in which maxima are looked for. Values of different forests do not compare.
cv::Mat hough_image(const Forest& forest, int class_index, const RgbdFrame& frame, const DetectionSettings& settings);

}  // namespace houghstream
