#pragma once

#include <array>
#include <cstdint>

#include "detector/features/tile_plane.hpp"

namespace houghstream {

/// Arithmetic of the histograms of oriented gradients, one per pixel: 9 unsigned orientations, soft-binned, summed over
/// a 5x5 Gaussian window (Dalal & Triggs 2005 without block normalisation, as in Gall et al. 2011).
struct HistogramSteps {
  static constexpr int kBins = 9;
  static constexpr float kPerByte = 16.0F;  ///< steps of a gradient's share of a bin
  /// Weights of the 5x5 Gaussian window (sigma 1.2) along one axis, of 65536: of the pixel itself, its neighbours and
  /// theirs. Products are cut to whole steps, which takes kCut steps in the mean.
  static constexpr std::array<std::uint16_t, 3> kWeights = {22504, 15903, 5613};
  static constexpr std::uint16_t kCut = 2;
};

/// Shares of each pixel's gradient in the bins, in steps.
using BinPlanes = std::array<TilePlane<std::uint16_t>, HistogramSteps::kBins>;

/// Bins all of the gradients' pixels, margins included; `bins` have their size.
void bin_gradients(const TilePlane<float>& dx, const TilePlane<float>& dy, float gain, BinPlanes& bins);

/// Sums one bin over the window around every pixel of `bytes`, whose margin is smaller than that of `bin` by 2.
void smooth_bin(const TilePlane<std::uint16_t>& bin, TilePlane<std::uint8_t>& bytes);

}  // namespace houghstream
