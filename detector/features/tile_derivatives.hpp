#pragma once

#include <array>
#include <vector>

#include "detector/features/tile_plane.hpp"

namespace houghstream {

/// Derivatives of the lightness: |Ix|, |Iy|, |Ixx|, |Iyy| as bytes, and what histograms of gradients are made of.
struct LightnessDerivatives {
  std::array<TilePlane<std::uint8_t>, 4> bytes;
  TilePlane<float> dx;
  TilePlane<float> dy;
};

/// Computes the derivatives on all pixels of `out`, margins included; its margins are smaller than that of `lightness`
/// by at least 1.
void differentiate_lightness(const TilePlane<std::uint8_t>& lightness, LightnessDerivatives& out);

/// Kernels of Sobel derivatives, from order 0, the smoothing across, to order 2; all of one odd size and of unit gain.
using SobelKernels = std::array<std::vector<float>, 3>;
SobelKernels sobel_kernels(int size_px);

/// Limits of metric derivatives, since an occluding edge is no slope of a surface; bytes span them.
struct SlopeLimits {
  static constexpr float kSlope = 2.5F;       ///< metres per metre: 68 degrees
  static constexpr float kCurvature = 60.0F;  ///< 1/metres: a cylinder of 17 mm radius
};

/// Derivatives of the depth: dx, dy, dxx, dyy as bytes (128 = level or unknown), and the first two in metres per metre.
struct DepthDerivatives {
  std::array<TilePlane<std::uint8_t>, 4> bytes;
  TilePlane<float> dx;
  TilePlane<float> dy;
};

/// Computes the derivatives on all pixels of `out`, margins included; its margins are smaller than that of `depth` by
/// at least half a kernel.
void differentiate_depth(const TilePlane<float>& depth, const SobelKernels& kernels, float focal_px,
                         DepthDerivatives& out);

/// Metres to whole steps: 0 where unknown, at most 65535.
void quantise_depth(const TilePlane<float>& depth, float step, TilePlane<std::uint16_t>& steps);

}  // namespace houghstream
