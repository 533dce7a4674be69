#pragma once

#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"

// Textures of things that are not printed. All CV_8UC3 BGR, drawn from the given generator only.

namespace houghstream::world {

/// Smooth noise of several octaves, CV_32FC1, mean about 0, range about -1 to 1. `cells` is the number of
/// grid cells across the width in the coarsest octave.
cv::Mat smooth_noise(const cv::Size& size, double cells, int octaves, Random& random);

/// One colour with faint unevenness (`strength` 0-1): paint, plastic, glaze, plaster.
cv::Mat plain(const cv::Size& size, const cv::Scalar& colour, double strength, Random& random);

cv::Mat wood(const cv::Size& size, Random& random);
cv::Mat fabric(const cv::Size& size, const cv::Scalar& colour, Random& random);  ///< woven, sometimes striped
cv::Mat tiles(const cv::Size& size, Random& random);
cv::Mat stone(const cv::Size& size, Random& random);   ///< speckled worktop
cv::Mat carpet(const cv::Size& size, Random& random);  ///< floor textile
cv::Mat wallpaper(const cv::Size& size, Random& random);

/// Brushed or cast metal.
cv::Mat metal(const cv::Size& size, Random& random);

}  // namespace houghstream::world
