#pragma once

#include <opencv2/core.hpp>

#include "tools/evaluate/metrics/calibration.hpp"

namespace houghstream {

/// Draws two reliability diagrams side by side, CV_8UC3: the true fraction over the prediction, with the number of
/// predictions of each bin below. On the diagonal predictions hold.
cv::Mat reliability_image(const Calibration& score, const Calibration& quality);

}  // namespace houghstream
