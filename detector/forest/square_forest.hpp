#pragma once

#include <cstdint>
#include <vector>

#include "detector/forest/forest.hpp"

namespace houghstream {

/// A node made ready for squares of patches. A word's highest byte is the pixel's plane, the two bytes below are its
/// step (see step_number).
struct SquareNode {
  static constexpr std::uint32_t kInverted = 1;  ///< goes right where the comparison fails
  static constexpr std::uint32_t kWraps = 2;     ///< the difference, modulo 256 and plus 128, is compared
  static constexpr std::uint32_t kAlone = 4;     ///< the second pixel counts as 0
  static constexpr int kStepShift = 8;
  static constexpr std::uint32_t kStepMask = 0xFFFF;
  static constexpr int kPlaneShift = 24;

  std::uint32_t first = 0;   ///< first pixel; lowest byte: the limit
  std::uint32_t second = 0;  ///< second pixel; lowest byte: kInverted, kWraps and kAlone
  std::int32_t left = 0;     ///< as in TreeNode
  std::int32_t right = 0;
};

/// Of the (2 * radius + 1)^2 steps of a patch's tests, row by row.
inline std::uint32_t step_number(int dx, int dy, int radius) {
  return static_cast<std::uint32_t>((dy + radius) * (2 * radius + 1) + dx + radius);
}

/// A forest made ready for squares of patches.
struct SquareForest {
  explicit SquareForest(const Forest& forest);

  int radius;  ///< of PatchSettings
  std::vector<SquareNode> nodes;
  std::vector<std::int32_t> roots;  ///< as in Forest
};

}  // namespace houghstream
