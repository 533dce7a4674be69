#pragma once

#include "detector/detector_settings.hpp"
#include "detector/features/feature_image.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream {

/// Which plane is which in a FeatureImage: the paper's final feature vector (Section 4, end), 60 planes.
/// Planes come in pairs, the maximum of a 5x5 neighbourhood at i and its minimum at i + count.
struct FeatureLayout {
  static constexpr int kIntensity = 16;  ///< L, a, b, |Ix|, |Iy|, |Ixx|, |Iyy|, 9 HoG bins (Gall et al. 2011)
  static constexpr int kDepth = 14;      ///< depth, dx, dy, dxx, dyy, 9 depth HoG bins (Janoch et al. 2011)
  static constexpr int kDepthMax = 2 * kIntensity;      ///< plane of the scaled depth's maximum
  static constexpr int kDepthMin = kDepthMax + kDepth;  ///< and of its minimum
  static constexpr int kPlanes = 2 * (kIntensity + kDepth);

  /// The two depth planes hold depth / kDepthStep modulo 256: a difference of two of them is taken modulo 256 too
  /// and is then exact for surfaces less than 0.5 m apart, at any distance (the scaled depth of Section 3.2
  /// as a test sees it once its two points are depth-normalised).
  static constexpr float kDepthStep = 0.004F;  ///< metres
  static constexpr bool wraps(int plane) { return plane == kDepthMax || plane == kDepthMin; }
};

/// All planes of a working frame. Where depth is missing beyond repair the depth planes are neutral: no slope, no
/// curvature, empty histograms.
FeatureImage compute_features(const WorkingFrame& frame, const FeatureSettings& settings, int threads);

/// The 16 intensity planes before minimum and maximum, CV_8UC1 each.
std::vector<cv::Mat> intensity_planes(const cv::Mat& colour_bgr);

/// The 14 depth planes before minimum and maximum: the first is CV_32FC1 metres, the others CV_8UC1.
std::vector<cv::Mat> depth_planes(const WorkingFrame& frame, const FeatureSettings& settings);

/// Histogram of oriented gradients per pixel: 9 unsigned orientations, soft-binned, summed over a 5x5 Gaussian window
/// (Dalal & Triggs 2005 without block normalisation, as in Gall et al. 2011). `gain` maps to 0..255.
std::vector<cv::Mat> gradient_histograms(const cv::Mat& dx, const cv::Mat& dy, float gain);

}  // namespace houghstream
