#include "detector/forest/square_forest.hpp"

#include <algorithm>
#include <utility>

namespace houghstream {
namespace {

struct Comparison {
  std::uint32_t limit = 0;
  std::uint32_t flags = 0;
  bool swapped = false;  ///< the second pixel less the first one
};

/// `difference >= threshold` for bytes: a subtraction either stops at 0 or, where it wraps, is shifted by 128.
Comparison as_bytes(const PixelTest& test) {
  const int threshold = test.threshold;
  if (test.kind == PixelTest::kWrapping) {
    if (threshold > 127) return {0, SquareNode::kWraps | SquareNode::kInverted, false};  // never: not (any >= 0)
    return {static_cast<std::uint32_t>(std::max(0, threshold + 128)), SquareNode::kWraps, false};
  }
  if (threshold > 0) return {static_cast<std::uint32_t>(threshold), 0, false};
  return {static_cast<std::uint32_t>(1 - threshold), SquareNode::kInverted, true};  // not (p2 - p1 >= 1 - threshold)
}

SquareNode make_node(const TreeNode& node, std::uint32_t first, std::uint32_t second) {
  const Comparison comparison = as_bytes(node.test);
  if (comparison.swapped) std::swap(first, second);
  std::uint32_t limit = comparison.limit;
  if (limit > 255) {  // out of reach, as 1 is of a pixel less itself
    second = first;
    limit = 1;
  }
  return {first << 8 | limit, second << 8 | comparison.flags, node.left, node.right};
}

}  // namespace

SquareLayout::SquareLayout(int reach_px, int plane_count)
    : reach(reach_px),
      planes(plane_count),
      row_stride(kSquareSide + 2 * reach_px),
      plane_stride(row_stride * row_stride) {}

SquareForest::SquareForest(const Forest& forest, std::int32_t scale, int planes)
    : layout((forest.patch.radius * scale + 128) >> 8, planes), roots(forest.roots) {
  const PatchView patch{nullptr, scale, layout.row_stride, 1};
  const std::ptrdiff_t centre = layout.reach * layout.row_stride + layout.reach;
  const auto zeros = static_cast<std::ptrdiff_t>(planes) * layout.plane_stride;
  nodes.reserve(forest.nodes.size());
  for (const TreeNode& node : forest.nodes) {
    const PixelTest& test = node.test;
    const std::ptrdiff_t plane = centre + static_cast<std::ptrdiff_t>(test.plane) * layout.plane_stride;
    const std::ptrdiff_t first = plane + patch_offset(patch, test.dx1, test.dy1);
    const bool alone = test.kind == PixelTest::kAlone;
    const std::ptrdiff_t second = alone ? zeros : plane + patch_offset(patch, test.dx2, test.dy2);
    nodes.push_back(make_node(node, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second)));
  }
}

}  // namespace houghstream
