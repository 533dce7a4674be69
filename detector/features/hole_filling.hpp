#pragma once

#include <opencv2/core.hpp>

namespace houghstream {

/// NaN pixels of a depth image (CV_32FC1) borrow the nearest measured depth, unless it is farther away than
/// `max_distance_px`. Distances are those of the 5x5 chamfer mask (Borgefors 1986), within 2 % of the true ones. The
/// time taken grows with the number of holes.
void fill_holes(cv::Mat& depth, float max_distance_px);

}  // namespace houghstream
