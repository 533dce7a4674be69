#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/feature_families.hpp"
#include "detector/features/tile_derivatives.hpp"
#include "detector/features/tile_extremes.hpp"
#include "detector/features/tile_histograms.hpp"
#include "detector/features/tile_plane.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream {

/// Inputs of a part's planes.
struct TileSources {
  const WorkingFrame& frame;
  const FeatureSettings& settings;
  const FeatureLayout& layout;
  const std::array<cv::Mat, 3>& lab;              ///< CV_8UC1 each; right where the part and lab_margin() around it are
  const SobelKernels& kernels;                    ///< kernels of the depth derivatives
  const std::vector<std::vector<cv::Mat>>& base;  ///< planes that were computed beforehand, by block: CV_8UC1 planes
};

/// Works out all planes of a part, of the size of a few tiles, so that they stay in the cache. To be kept from part to
/// part for its memory.
class TileFeatures {
 public:
  /// Computes the planes of `part`, at most kMaxPart pixels wide, into rows().
  void compute(const TileSources& sources, cv::Rect part);
  const TileRows& rows() const { return rows_; }

 private:
  void add_intensity(const TileSources& sources, const FeatureBlock& block);
  void add_depth_value(const TileSources& sources, const FeatureBlock& block);
  void add_derivatives(const FeatureBlock& block);
  void add_histograms(const TilePlane<float>& dx, const TilePlane<float>& dy, float gain, int first, int count);
  void add_base(const std::vector<cv::Mat>& base, const FeatureBlock& block);
  void derive_depth_of(const TileSources& sources);
  /// Adds the extremes of a base plane, the `index`-th of a block that begins at `first` and holds `count`.
  void add_extremes(const TilePlane<std::uint8_t>& plane, int first, int index, int count);

  cv::Rect part_;
  cv::Rect image_;  // image relative to the part's first pixel
  Neighbourhood around_;
  TilePlane<std::uint8_t> plane_;
  TilePlane<float> metres_;
  TilePlane<std::uint16_t> steps_;
  LightnessDerivatives lightness_;
  DepthDerivatives depth_;
  BinPlanes bins_;
  TileRows rows_;
};

// Gains of gradient histograms, which map gradients to 0..255: times the largest gradient they stay below 2000, so that
// sums fit into 16 bits.
constexpr float kIntensityGain = 8.0F;  ///< gain of gradients of the lightness per pixel
constexpr float kDepthGain = 160.0F;    ///< gain of depth gradients, metres per metre

/// Quantisation steps of depth, see PlaneKind.
struct DepthSteps {
  float metres = 0.0F;
  StepBytes bytes = StepBytes::kWrapped;
};
DepthSteps depth_steps(const WorkingFrame& frame, const FeatureSettings& settings);

/// Returns the margin around a part that its intensity planes need, pixels.
int lab_margin(const FeatureSettings& settings);

}  // namespace houghstream
