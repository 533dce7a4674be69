#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/feature_families.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream::baseline {

/// Gives the program the search of a scale space and the surface features, see extensions.hpp. The first line of main,
/// before any thread starts.
void use_baseline();

/// The planes of a surface family before minimum and maximum, CV_8UC1; none of the other families.
std::vector<cv::Mat> surface_planes(FeatureFamily family, const WorkingFrame& frame, int threads);

}  // namespace houghstream::baseline
