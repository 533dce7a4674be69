#pragma once

#include <opencv2/core.hpp>

#include "pipeline/base/random.hpp"

namespace houghstream {

/// A scale space shows an object `ratio` times as far away as taught in an enlarged image: its size is the same then,
/// but not the sensor's noise, which is that of the larger distance and as much coarser. Adds what is missing of it to
/// a picture taken at `distance` metres; `depth` is CV_32FC1, metres. What smooth surfaces' normals have
/// told nearby would not be true of rough ones farther away.
void add_far_noise(double distance, double ratio, cv::Mat& depth, Random& random);

}  // namespace houghstream
