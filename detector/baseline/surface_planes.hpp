#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/feature_families.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream {

/// The planes of a surface family before minimum and maximum, CV_8UC1; none where TileFeatures work them out.
std::vector<cv::Mat> surface_planes(FeatureFamily family, const WorkingFrame& frame, int threads);

}  // namespace houghstream
