#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Some of a model's points on their way to being paired, one array per coordinate; camera frame, metres.
struct PairBlock {
  static constexpr std::size_t kSize = 64;
  using Values = std::array<float, kSize>;
  std::size_t count = 0;                         ///< points that are set
  alignas(64) Values x{}, y{}, z{};              ///< z > 0
  alignas(64) Values gap_x{}, gap_y{}, gap_z{};  ///< from the point to the measured one; 0 without
  alignas(64) Values distance_sq{};              ///< of them; the square of PairSearch::distance_m without
};

/// Where measured points are looked for: a lattice of pixels about that of the model's point.
struct PairSearch {
  float distance_m = 0.0F;  ///< measured points farther away are none; the lattice reaches as far to each side
  int steps = 1;            ///< of the lattice to each side
};

/// Fills in the gap from each of the block's points to the measured point nearest to it on its lattice.
void find_gaps(const RgbdFrame& frame, const PairSearch& search, PairBlock& block);

/// The same point by point, bit for bit.
void find_gaps_readably(const RgbdFrame& frame, const PairSearch& search, PairBlock& block);

/// Eight values of a pair; rows of a least-squares problem.
struct alignas(32) PairRow {
  std::array<float, 8> values{};
};
using PairRows = std::array<PairRow, PairBlock::kSize>;

/// Sum of weighted products of such values, by columns; single precision and a width of eight suit vector units.
using PairSums = Eigen::Matrix<float, 8, 8>;

/// Adds weight * row * row^T of the first `count` rows, in their order.
void add_products(const PairRows& rows, const PairBlock::Values& weights, std::size_t count, PairSums& sums);

/// The same row by row, bit for bit.
void add_products_readably(const PairRows& rows, const PairBlock::Values& weights, std::size_t count, PairSums& sums);

}  // namespace houghstream
