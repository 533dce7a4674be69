#pragma once

#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"

namespace houghstream::training {

/// An object taught in haze or in weak light as it may look without: the darkest of it becomes darker, all of it
/// brighter and its colours stronger, by random shares of what its own range allows.
void remove_haze(const cv::Mat& mask, cv::Mat& colour, Random& random);

/// An object taught out of focus, or through a lens that blurs, as a sharper camera may see it: what a Gaussian of 1.5
/// pixels takes from the image (CV_8UC3) is added `sharpness` times. 0: the image itself, its pixels shared.
cv::Mat apply_unsharp_mask(const cv::Mat& colour, double sharpness);

}  // namespace houghstream::training
