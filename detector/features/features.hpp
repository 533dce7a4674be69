#pragma once

#include <opencv2/core.hpp>

#include "detector/detector_settings.hpp"
#include "detector/features/feature_families.hpp"
#include "detector/features/feature_image.hpp"
#include "detector/features/feature_tiles.hpp"
#include "detector/features/tiles/tile_extremes.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream {

/// All planes of a working frame in the order of FeatureLayout(settings). Where depth is missing beyond repair the
/// depth planes are neutral: no slope, no curvature, empty histograms.
FeatureImage compute_features(const WorkingFrame& frame, const FeatureSettings& settings, int threads);

/// The same in the wanted tiles, which are of the frame's size, and in the border beside them. What else is in `image`,
/// which keeps its memory, is undefined: left over from earlier frames.
void compute_features(const WorkingFrame& frame, const FeatureSettings& settings, const FeatureTiles& tiles,
                      int threads, FeatureImage& image);

/// The same planes, one after another, each for the whole frame: slowly.
FeatureImage compute_features_readably(const WorkingFrame& frame, const FeatureSettings& settings);

/// The 16 intensity planes before minimum and maximum, CV_8UC1 each; readably.
std::vector<cv::Mat> intensity_planes(const cv::Mat& colour_bgr);

/// Planes of the families that need derivatives of the depth, readably; empty where settings.families lacks one.
struct DepthPlanes {
  std::vector<cv::Mat> derivatives;  ///< dx, dy, dxx, dyy: CV_8UC1, 128 = level or unknown
  std::vector<cv::Mat> hog;          ///< 9 bins, CV_8UC1
};
DepthPlanes depth_planes(const WorkingFrame& frame, const FeatureSettings& settings);

/// Histogram of oriented gradients per pixel: 9 unsigned orientations, soft-binned, summed over a 5x5 Gaussian window
/// (Dalal & Triggs 2005 without block normalisation, as in Gall et al. 2011). `gain` maps to 0..255; times the largest
/// gradient it stays below 2000, so that the sums fit into 16 bits.
std::vector<cv::Mat> gradient_histograms(const cv::Mat& dx, const cv::Mat& dy, float gain);
constexpr float kIntensityGain = 8.0F;  ///< of gradients of the lightness per pixel
constexpr float kDepthGain = 160.0F;    ///< of metres per metre

/// The steps in which depth is told, see PlaneKind.
struct DepthSteps {
  float metres = 0.0F;
  StepBytes bytes = StepBytes::kWrapped;
};
DepthSteps depth_steps(const WorkingFrame& frame, const FeatureSettings& settings);

}  // namespace houghstream
