#include "detector/forest/packed_trees.hpp"

#include <algorithm>
#include <cstdlib>

namespace houghstream {
namespace {

constexpr std::size_t kMaxNodes = std::size_t{1} << packed::kThresholdShift;
constexpr int kMaxThreshold = 255;  // differences of bytes do not exceed it

std::uint32_t step_bits(int step, int place) {
  constexpr std::uint32_t kMask = (1U << packed::kStepBits) - 1;
  return (static_cast<std::uint32_t>(step) & kMask) << (place * packed::kStepBits);
}

bool fits(const PixelTest& test) {
  constexpr int kMaxDistance = (1 << (packed::kStepBits - 1)) - 1;
  return std::max({std::abs(test.dx1), std::abs(test.dy1), std::abs(test.dx2), std::abs(test.dy2)}) <= kMaxDistance;
}

std::int32_t pack_branch(std::size_t left, int threshold) {
  const auto bits = static_cast<std::uint32_t>(threshold) << packed::kThresholdShift | static_cast<std::uint32_t>(left);
  return static_cast<std::int32_t>(bits);
}

/// Packs a node. A test of one pixel reads it twice, since a second pixel would come into the cache for nothing.
PackedNode pack_node(const PixelTest& test, std::size_t left) {
  const bool single_pixel = test.kind == PixelTest::kSinglePixel;
  std::uint32_t bits = step_bits(test.dx1, 0) | step_bits(test.dy1, 1);
  bits |= step_bits(single_pixel ? test.dx1 : test.dx2, 2) | step_bits(single_pixel ? test.dy1 : test.dy2, 3);
  bits |= static_cast<std::uint32_t>(test.plane) << packed::kPlaneShift;
  if (single_pixel) bits |= packed::kSinglePixel;
  if (test.kind == PixelTest::kWrapping) bits |= packed::kWraps;
  return {bits, pack_branch(left, std::clamp(test.threshold - 1, -kMaxThreshold - 1, kMaxThreshold))};
}

/// Appends one tree, breadth first. Returns false where it does not fit.
bool append_packed(const Forest& forest, std::int32_t root, PackedTrees& trees) {
  const std::size_t maximum = std::min(kMaxNodes, forest.roots.size() + 2 * forest.nodes.size());
  std::vector<std::int32_t> sources = {root};
  const std::size_t first = trees.nodes.size();
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::int32_t source = sources[i];
    if (source < 0) {
      trees.nodes.push_back({packed::kLeaf, -1 - source});
      continue;
    }
    const TreeNode& node = forest.nodes[static_cast<std::size_t>(source)];
    if (!fits(node.test) || first + sources.size() + 2 > maximum) return false;
    trees.nodes.push_back(pack_node(node.test, first + sources.size()));
    sources.push_back(node.left);
    sources.push_back(node.right);
  }
  return true;
}

}  // namespace

PackedTrees pack_trees(const Forest& forest) {
  PackedTrees trees;
  for (const std::int32_t root : forest.roots) {
    trees.roots.push_back(static_cast<std::int32_t>(trees.nodes.size()));
    if (!append_packed(forest, root, trees)) return {};
  }
  return trees;
}

void fetch_nodes(const PackedNode* nodes, const std::int32_t* at, std::size_t count, PackedNode* fetched) {
  for (std::size_t i = 0; i < count; ++i) fetched[i] = nodes[at[i]];
}

void fetch_pixels(const std::uint8_t* origin, const PixelPairs& pairs, std::size_t count) {
  const auto [first, second, first_values, second_values] = pairs;
  for (std::size_t i = 0; i < count; ++i) {
    first_values[i] = origin[first[i]];
    second_values[i] = origin[second[i]];
  }
}

}  // namespace houghstream
