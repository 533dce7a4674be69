#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "detector/baseline/point_histogram_settings.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream::baseline {

/// CV_8UC1 planes of the frame's size, each pixel with the values of its cell, 255 for 100 percent. All are 0 where the
/// pixel or the middle of its cell has no surface, or where these are not the same one.

/// Computes 3 x fpfh_bins planes: one histogram for each of the three angles between pairs of normals.
std::vector<cv::Mat> fpfh_planes(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads);

/// Computes pfh_bins^3 planes: one histogram of the three angles together.
std::vector<cv::Mat> pfh_planes(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads);

}  // namespace houghstream::baseline
