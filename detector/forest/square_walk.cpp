// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/forest/square_walk.cpp"
#include "detector/forest/square_walk.hpp"

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int kPatches = kSquarePatches;
constexpr int kFewest = 8;  // patches that stay together

/// The patches of one row that stand at one node, a bit each.
struct Row {
  std::uint32_t patches;
  std::int32_t y;
};

/// The patches that stand at one node.
struct Crowd {
  std::int32_t node;
  int rows;
};

/// Crowds of one depth and, one after another, their rows.
struct Depth {
  std::array<Crowd, kPatches> crowds;
  std::array<Row, kPatches + kSquareSide> rows;  // the spare ones may be written in vain
  int crowd_count = 0;
  int row_count = 0;
};

/// Patches that walk on their own, perhaps down several trees.
struct Walkers {
  std::array<std::int32_t, 2 * kPatches> start;  // y * row_stride + x of the patch, bytes
  std::array<std::int32_t, 2 * kPatches> leaf;   // where it is to be noted
  std::array<std::int32_t, 2 * kPatches> node;
  int count = 0;
};

/// A group's walk down one tree.
struct Walk {
  const SquareNode* nodes;
  const PatchSquare& square;
  const std::int32_t* places;  // of the group
  const std::uint8_t* planes;
  std::int32_t* leaves;     // of all trees
  std::int32_t first_leaf;  // of this tree's

  std::int32_t leaf_of(std::int32_t patch) const {  // into `leaves`
    return first_leaf + square.numbers[static_cast<std::size_t>(patch)];
  }

  /// Distance of the pixel that a word of a node stands for from y * row_stride + x of the patch, bytes.
  std::int32_t place(std::uint32_t word) const {
    return static_cast<std::int32_t>(word >> SquareNode::kPlaneShift) * square.layout.plane_stride +
           places[word >> SquareNode::kStepShift & SquareNode::kStepMask];
  }
  /// Pixels that count as 0.
  const std::uint8_t* zeros() const { return planes + square.layout.planes * square.layout.plane_stride; }
};

/// Which of kSquareSide neighbouring patches pass a node's comparison.
template <bool kWraps>
HWY_INLINE std::uint32_t passing(const std::uint8_t* first, const std::uint8_t* second, std::uint8_t limit) {
  const hn::CappedTag<std::uint8_t, kSquareSide> d;
  const auto least = hn::Set(d, limit);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kSquareSide; i += hn::Lanes(d)) {
    const auto p1 = hn::LoadU(d, first + i);
    const auto p2 = hn::LoadU(d, second + i);
    const auto value = kWraps ? hn::Xor(hn::Sub(p1, p2), hn::Set(d, 128)) : hn::SaturatedSub(p1, p2);
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, hn::Eq(hn::Max(value, least), value), bytes);
    std::uint32_t part;
    std::memcpy(&part, bytes, sizeof part);
    bits |= part << i;
  }
  return bits;
}

struct Split {
  int left = 0;  // rows
  int right = 0;
};

/// Sends the rows of a crowd left or right; a row may go both ways.
template <bool kWraps>
HWY_INLINE Split split_rows(const Walk& walk, const SquareNode& node, const Row* rows, int count, Row* left,
                            Row* right) {
  const std::uint8_t* first = walk.planes + walk.place(node.first);
  const bool alone = (node.second & SquareNode::kAlone) != 0;
  const std::uint8_t* second = alone ? walk.zeros() : walk.planes + walk.place(node.second);
  const auto limit = static_cast<std::uint8_t>(node.first);
  const std::uint32_t inverted = (node.second & SquareNode::kInverted) != 0 ? ~0U : 0U;
  const std::ptrdiff_t row_stride = walk.square.layout.row_stride;
  Split split;
  for (int i = 0; i < count; ++i) {
    const Row row = rows[i];
    const std::ptrdiff_t begin = row.y * row_stride;
    const std::uint32_t passes = passing<kWraps>(first + begin, second + begin, limit) ^ inverted;
    right[split.right] = {row.patches & passes, row.y};
    left[split.left] = {row.patches & ~passes, row.y};
    split.right += (row.patches & passes) != 0 ? 1 : 0;
    split.left += (row.patches & ~passes) != 0 ? 1 : 0;
  }
  return split;
}

template <typename Visit>
HWY_INLINE void for_patches(const Row* rows, int count, const Visit& visit) {
  for (int i = 0; i < count; ++i) {
    for (std::uint32_t bits = rows[i].patches; bits != 0; bits &= bits - 1) {
      visit(rows[i].y * kSquareSide + static_cast<std::int32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits)));
    }
  }
}

/// What becomes of rows that were written behind a depth's last ones: leaves, walkers, or a crowd of that depth.
HWY_INLINE void settle(const Walk& walk, std::int32_t node, int rows, Depth& depth, Walkers& walkers) {
  const Row* begin = depth.rows.data() + depth.row_count;
  if (node < 0) {
    for_patches(begin, rows, [&](std::int32_t patch) { walk.leaves[walk.leaf_of(patch)] = -1 - node; });
    return;
  }
  hwy::Prefetch(&walk.nodes[node]);
  int patches = 0;
  if (rows < kFewest) {
    for (int i = 0; i < rows; ++i) patches += static_cast<int>(hwy::PopCount(begin[i].patches));
  }
  if (rows < kFewest && patches < kFewest) {
    for_patches(begin, rows, [&](std::int32_t patch) {
      walkers.start[walkers.count] = patch / kSquareSide * walk.square.layout.row_stride + patch % kSquareSide;
      walkers.leaf[walkers.count] = walk.leaf_of(patch);
      walkers.node[walkers.count++] = node;
    });
    return;
  }
  depth.crowds[depth.crowd_count++] = {node, rows};
  depth.row_count += rows;
}

/// One test for each crowd.
HWY_INLINE void go_deeper(const Walk& walk, const Depth& from, Depth& to, Walkers& walkers) {
  std::array<Row, kSquareSide> right;
  to.crowd_count = to.row_count = 0;
  const Row* rows = from.rows.data();
  for (int c = 0; c < from.crowd_count; ++c) {
    const Crowd crowd = from.crowds[c];
    const SquareNode& node = walk.nodes[crowd.node];
    Row* left = to.rows.data() + to.row_count;
    const Split split = (node.second & SquareNode::kWraps) != 0
                            ? split_rows<true>(walk, node, rows, crowd.rows, left, right.data())
                            : split_rows<false>(walk, node, rows, crowd.rows, left, right.data());
    if (split.left > 0) settle(walk, node.left, split.left, to, walkers);
    if (split.right > 0) {
      Row* behind = to.rows.data() + to.row_count;
      for (int i = 0; i < split.right; ++i) behind[i] = right[i];
      settle(walk, node.right, split.right, to, walkers);
    }
    rows += crowd.rows;
  }
}

/// Node that a patch reaches by a node's test; without a branch that nobody can predict.
HWY_INLINE std::int32_t next_node(const Walk& walk, const SquareNode& node, const std::uint8_t* start) {
  const int second_mask = (node.second & SquareNode::kAlone) != 0 ? 0 : 255;
  const int difference = start[walk.place(node.first)] - (start[walk.place(node.second)] & second_mask);
  const int value = (node.second & SquareNode::kWraps) != 0 ? (difference + 128) & 255 : difference;
  const bool passes = value >= static_cast<int>(node.first & 255U);
  return passes != ((node.second & SquareNode::kInverted) != 0) ? node.right : node.left;
}

/// Steps of all walkers by turns, so that their cache misses overlap; those that have arrived make room.
void walk_together(const Walk& walk, Walkers& walkers) {
  while (walkers.count > 0) {
    int walking = 0;
    for (int i = 0; i < walkers.count; ++i) {
      const std::int32_t start = walkers.start[i];
      const std::int32_t leaf = walkers.leaf[i];
      const std::int32_t next = next_node(walk, walk.nodes[walkers.node[i]], walk.planes + start);
      hwy::Prefetch(&walk.nodes[std::max(next, 0)]);
      walk.leaves[leaf] = -1 - next;  // is written over until it is one
      walkers.start[walking] = start;
      walkers.leaf[walking] = leaf;
      walkers.node[walking] = next;
      walking += next >= 0 ? 1 : 0;
    }
    walkers.count = walking;
  }
}

void walk_tree(const Walk& walk, std::int32_t root, const SquareGroup& group, Walkers& walkers) {
  Depth a;
  Depth b;
  int rows = 0;
  for (int y = 0; y < walk.square.height; ++y) {
    const std::uint32_t patches = group.rows[static_cast<std::size_t>(y)];
    if (patches != 0) a.rows[static_cast<std::size_t>(rows++)] = {patches, y};
  }
  settle(walk, root, rows, a, walkers);
  Depth* from = &a;
  Depth* to = &b;
  while (from->crowd_count > 0) {
    go_deeper(walk, *from, *to, walkers);
    std::swap(from, to);
  }
}

void walk_trees(const SquareForest& forest, int trees, const PatchSquare& square, const std::uint8_t* planes,
                std::int32_t* leaves) {
  Walkers walkers;
  for (std::size_t g = 0; g < square.group_count; ++g) {
    const SquareGroup& group = square.groups[g];
    Walk walk{forest.nodes.data(), square, group.places.data(), planes, leaves, 0};
    for (int tree = 0; tree < trees; ++tree, walk.first_leaf += square.count) {
      walk_tree(walk, forest.roots[tree], group, walkers);
      if (walkers.count > kPatches) walk_together(walk, walkers);  // there must be room for another tree's
    }
    walk_together(walk, walkers);
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(walk_trees);

void walk_square(const SquareForest& forest, int trees, const PatchSquare& square,
                 const std::vector<std::uint8_t>& planes, std::int32_t* leaves) {
  HWY_DYNAMIC_DISPATCH(walk_trees)(forest, trees, square, planes.data(), leaves);
}

}  // namespace houghstream
#endif
