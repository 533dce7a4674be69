#pragma once

#include <opencv2/core.hpp>

#include "detector/detector_settings.hpp"
#include "detector/features/feature_families.hpp"
#include "detector/features/feature_image.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream {

/// All planes of a working frame in the order of FeatureLayout(settings). Where depth is missing beyond repair the
/// depth planes are neutral: no slope, no curvature, empty histograms.
FeatureImage compute_features(const WorkingFrame& frame, const FeatureSettings& settings, int threads);

/// The 16 intensity planes before minimum and maximum, CV_8UC1 each.
std::vector<cv::Mat> intensity_planes(const cv::Mat& colour_bgr);

/// Planes of the families that need derivatives of the depth; empty where settings.families lacks one.
struct DepthPlanes {
  std::vector<cv::Mat> derivatives;  ///< dx, dy, dxx, dyy: CV_8UC1, 128 = level or unknown
  std::vector<cv::Mat> hog;          ///< 9 bins, CV_8UC1
};
DepthPlanes depth_planes(const WorkingFrame& frame, const FeatureSettings& settings);

/// Histogram of oriented gradients per pixel: 9 unsigned orientations, soft-binned, summed over a 5x5 Gaussian window
/// (Dalal & Triggs 2005 without block normalisation, as in Gall et al. 2011). `gain` maps to 0..255.
std::vector<cv::Mat> gradient_histograms(const cv::Mat& dx, const cv::Mat& dy, float gain);

}  // namespace houghstream
