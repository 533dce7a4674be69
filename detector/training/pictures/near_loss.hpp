#pragma once

#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"

namespace houghstream {

/// What a structured-light camera makes of what stands too near: its own pattern dazzles it. Surfaces nearer than
/// `limit` metres keep their depth in patches only, of random size and together a share of `kept`, 0 to 1. `depth` is
/// CV_32FC1, metres, NaN = none.
void lose_near_depth(double limit, double kept, cv::Mat& depth, Random& random);

}  // namespace houghstream
