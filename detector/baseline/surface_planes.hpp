#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/features.hpp"

namespace houghstream::baseline {

/// Returns the planes of a surface family before minimum and maximum, CV_8UC1; none of the other families.
std::vector<cv::Mat> surface_planes(FeatureFamily family, const WorkingFrame& frame, int threads);

/// Returns the planes of all surface families among the settings', for compute_features.
ExtraPlanes extra_planes(const WorkingFrame& frame, const FeatureSettings& settings, int threads);

}  // namespace houghstream::baseline
