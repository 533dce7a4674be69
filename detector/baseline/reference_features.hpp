#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/features/feature_settings.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream::baseline {

/// Computes the planes of compute_features, one after another, each for the whole frame, as its reference.
FeatureImage reference_features(const WorkingFrame& frame, const FeatureSettings& settings);

/// Returns the 16 intensity planes before minimum and maximum, CV_8UC1 each.
std::vector<cv::Mat> intensity_planes(const cv::Mat& colour_bgr);

/// Planes of the families that need derivatives of the depth; empty where settings.families lacks one.
struct DepthPlanes {
  std::vector<cv::Mat> derivatives;  ///< dx, dy, dxx, dyy: CV_8UC1, 128 = level or unknown
  std::vector<cv::Mat> hog;          ///< 9 bins, CV_8UC1
};
DepthPlanes depth_planes(const WorkingFrame& frame, const FeatureSettings& settings);

/// Computes a histogram of oriented gradients per pixel, see HistogramSteps. `gain` maps to 0..255; times the largest
/// gradient it stays below 2000, so that the sums fit into 16 bits.
std::vector<cv::Mat> gradient_histograms(const cv::Mat& dx, const cv::Mat& dy, float gain);

}  // namespace houghstream::baseline
