#pragma once

#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"

namespace houghstream::training {

/// Changes an object that was taught in haze or in weak light into one without: the darkest of it becomes darker, all
/// of it brighter and its colours stronger, by random fractions of what its own range allows.
void remove_haze(const cv::Mat& mask, cv::Mat& colour, Random& random);

/// Sharpens an object that was taught out of focus, or through a lens that blurs: adds `sharpness` times the difference
/// between the image (CV_8UC3) and its Gaussian blur of 1.5 pixels. Returns the image itself for 0, its pixels shared.
cv::Mat apply_unsharp_mask(const cv::Mat& colour, double sharpness);

}  // namespace houghstream::training
