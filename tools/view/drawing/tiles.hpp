#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace houghstream::view {

/// Returns images of one size and type CV_8UC3 row by row, `columns` in a row, with a little grey between them. At
/// least one is required.
cv::Mat tiled(const std::vector<cv::Mat>& tiles, int columns);

}  // namespace houghstream::view
