#pragma once

#include <cstdint>
#include <vector>

#include "detector/forest/forest.hpp"

namespace houghstream {

constexpr int kSquareSide = 32;  ///< patches a side, so that a row of them is a word with a bit each

/// Where the pixels that a square's patches look at lie, plane by plane.
struct SquareLayout {
  SquareLayout(int reach_px, int plane_count);

  int reach = 0;         ///< pixels beyond the square on each side
  int planes = 0;        ///< and behind them one of zeros
  int row_stride = 0;    ///< bytes
  int plane_stride = 0;  ///< bytes
  /// Bytes behind the planes, which may be read past their end by a vector.
  static constexpr int kSpare = 64;
  std::size_t size() const { return static_cast<std::size_t>((planes + 1) * plane_stride + kSpare); }
};

/// A node made ready for patches of one scale.
struct SquareNode {
  static constexpr std::uint32_t kInverted = 1;  ///< goes right where the comparison fails
  static constexpr std::uint32_t kWraps = 2;     ///< the difference, modulo 256 and plus 128, is compared

  std::uint32_t first = 0;   ///< distance from the patch to the first pixel, bytes, times 256, plus the limit
  std::uint32_t second = 0;  ///< to the second one, times 256, plus kInverted and kWraps
  std::int32_t left = 0;     ///< as in TreeNode
  std::int32_t right = 0;
};

/// A forest made ready for patches of one scale.
struct SquareForest {
  SquareForest(const Forest& forest, std::int32_t scale, int planes);

  SquareLayout layout;
  std::vector<SquareNode> nodes;
  std::vector<std::int32_t> roots;  ///< as in Forest
};

}  // namespace houghstream
