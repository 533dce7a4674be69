#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "detector/forest/forest.hpp"

namespace houghstream {

/// A node or leaf in the layout that traverse_batched() reads.
struct PackedNode {
  std::uint32_t test = 0;
  std::int32_t branch = 0;  ///< left child and threshold of an inner node; number of a leaf
};

/// A copy of the trees in the layout of traverse_batched(): eight bytes for each node and leaf; the right child follows
/// the left one.
struct PackedTrees {
  std::vector<PackedNode> nodes;    ///< nodes and leaves; empty: see pack_trees
  std::vector<std::int32_t> roots;  ///< per tree, into nodes
};

/// Layout of a PackedNode, from the lowest bits on.
namespace packed {
constexpr int kStepBits = 5;  ///< bits of dx1, dy1, dx2 and dy2 each, with sign
constexpr int kPlaneShift = 20;
constexpr std::uint32_t kSinglePixel = 1U << 28;
constexpr std::uint32_t kWraps = 1U << 29;
constexpr std::uint32_t kLeaf = 1U << 30;  ///< no other bit is set, and the branch is the leaf's number
constexpr int kThresholdShift = 23;  ///< shift within the branch: below lies the left child, above it the threshold,
                                     ///< with sign
}  // namespace packed

/// Packs the forest's roots and nodes. Empty where the trees do not fit: patches with a radius above 15 steps, more
/// than 2^23 nodes and leaves, or nodes with several parents.
PackedTrees pack_trees(const Forest& forest);

/// Copies the current nodes of patches, and the values of the pixels that these test, side by side. It is compiled
/// apart from the traversal, whose instruction set has gathers: where the cache misses, dozens of plain loads overlap,
/// but few gathers do.
void fetch_nodes(const PackedNode* nodes, const std::int32_t* at, std::size_t count, PackedNode* fetched);
struct PixelPairs {
  const std::int32_t* first = nullptr;  ///< offsets of pixels from the origin, bytes
  const std::int32_t* second = nullptr;
  std::uint8_t* first_values = nullptr;
  std::uint8_t* second_values = nullptr;
};
void fetch_pixels(const std::uint8_t* origin, const PixelPairs& pairs, std::size_t count);

}  // namespace houghstream
