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
  if (test.kind == PixelTest::kAlone) return {static_cast<std::uint32_t>(std::max(0, threshold)), SquareNode::kAlone};
  if (threshold > 0) return {static_cast<std::uint32_t>(threshold), 0, false};
  return {static_cast<std::uint32_t>(1 - threshold), SquareNode::kInverted, true};  // not (p2 - p1 >= 1 - threshold)
}

SquareNode make_node(const TreeNode& node, int radius) {
  const PixelTest& test = node.test;
  Comparison comparison = as_bytes(test);
  const auto pixel = [&](int dx, int dy) {
    return static_cast<std::uint32_t>(test.plane) << SquareNode::kPlaneShift | step_number(dx, dy, radius)
                                                                                   << SquareNode::kStepShift;
  };
  std::uint32_t first = pixel(test.dx1, test.dy1);
  const bool alone = test.kind == PixelTest::kAlone;  // then the pixel is looked at twice, as in PackedNode
  std::uint32_t second = alone ? first : pixel(test.dx2, test.dy2);
  if (comparison.swapped) std::swap(first, second);
  if (comparison.limit > 255) {  // out of reach, as 1 is of a pixel less itself
    second = first;
    comparison.flags &= ~SquareNode::kAlone;
    comparison.limit = 1;
  }
  return {first | comparison.limit, second | comparison.flags, node.left, node.right};
}

}  // namespace

SquareForest::SquareForest(const Forest& forest) : radius(forest.patch.radius), roots(forest.roots) {
  nodes.reserve(forest.nodes.size());
  for (const TreeNode& node : forest.nodes) nodes.push_back(make_node(node, radius));
}

}  // namespace houghstream
