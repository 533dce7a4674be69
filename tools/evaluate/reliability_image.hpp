#pragma once

#include <opencv2/core.hpp>

#include "tools/evaluate/metrics/calibration.hpp"

namespace houghstream {

/// Two reliability diagrams side by side, CV_8UC3: what is true over what was stated, with the number of statements of
/// each bin below. On the diagonal what is stated holds.
cv::Mat reliability_image(const Calibration& score, const Calibration& quality);

}  // namespace houghstream
