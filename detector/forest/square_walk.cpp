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

// A node as four 32-bit words is what the gathers below rely on.
static_assert(sizeof(SquareNode) == 16 && offsetof(SquareNode, left) == 8);

constexpr int kPatches = kSquareSide * kSquareSide;
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2  // better targets have lower numbers
constexpr int kFewest = 8;                  // patches that stay together
#else
constexpr int kFewest = 2;  // without gathers a patch on its own is slow
#endif

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

/// Patches that walk on their own.
struct Walkers {
  static constexpr int kSpare = 64;                   // lanes of a vector behind the last one
  std::array<std::int32_t, kPatches + kSpare> patch;  // y * kSquareSide + x
  std::array<std::int32_t, kPatches + kSpare> node;
  int count = 0;
};

/// A walk down one tree.
struct Walk {
  const SquareForest& forest;
  const PatchSquare& square;
  const std::uint8_t* planes;
  std::int32_t* leaves;

  std::int32_t& leaf_of(std::int32_t patch) const {
    return leaves[patch / kSquareSide * square.width + patch % kSquareSide];
  }
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
  const std::uint8_t* first = walk.planes + (node.first >> 8);
  const std::uint8_t* second = walk.planes + (node.second >> 8);
  const auto limit = static_cast<std::uint8_t>(node.first);
  const std::uint32_t inverted = (node.second & SquareNode::kInverted) != 0 ? ~0U : 0U;
  const std::ptrdiff_t row_stride = walk.forest.layout.row_stride;
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
    for_patches(begin, rows, [&](std::int32_t patch) { walk.leaf_of(patch) = -1 - node; });
    return;
  }
  hwy::Prefetch(&walk.forest.nodes[node]);
  int patches = 0;
  if (rows < kFewest) {
    for (int i = 0; i < rows; ++i) patches += static_cast<int>(hwy::PopCount(begin[i].patches));
  }
  if (rows < kFewest && patches < kFewest) {
    for_patches(begin, rows, [&](std::int32_t patch) {
      walkers.patch[walkers.count] = patch;
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
    const SquareNode& node = walk.forest.nodes[crowd.node];
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

void walk_one_by_one(const Walk& walk, const Walkers& walkers) {
  const int row_stride = walk.forest.layout.row_stride;
  for (int i = 0; i < walkers.count; ++i) {
    const std::int32_t patch = walkers.patch[i];
    const std::uint8_t* place = walk.planes + patch / kSquareSide * row_stride + patch % kSquareSide;
    std::int32_t at = walkers.node[i];
    while (at >= 0) {
      const SquareNode& node = walk.forest.nodes[at];
      const int difference = place[node.first >> 8] - place[node.second >> 8];
      const int value = (node.second & SquareNode::kWraps) != 0 ? (difference + 128) & 255 : difference;
      const bool passes = value >= static_cast<int>(node.first & 255U);
      at = passes != ((node.second & SquareNode::kInverted) != 0) ? node.right : node.left;
    }
    walk.leaf_of(patch) = -1 - at;
  }
}

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
/// Node that each of a vector of patches reaches by its node's test.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V next_nodes(D d, const Walk& walk, V patch, V node) {
  const auto* words = reinterpret_cast<const std::int32_t*>(walk.forest.nodes.data());
  const V row = hn::ShiftRight<5>(patch);
  const V x = hn::And(patch, hn::Set(d, kSquareSide - 1));
  const V place = hn::Add(hn::Mul(row, hn::Set(d, walk.forest.layout.row_stride)), x);
  const V byte = hn::Set(d, 255);
  const V word = hn::ShiftLeft<2>(node);
  const V first = hn::GatherIndex(d, words, word);
  const V second = hn::GatherIndex(d, words + 1, word);
  const auto* pixels = reinterpret_cast<const std::int32_t*>(walk.planes);
  const V p1 = hn::And(hn::GatherOffset(d, pixels, hn::Add(hn::ShiftRight<8>(first), place)), byte);
  const V p2 = hn::And(hn::GatherOffset(d, pixels, hn::Add(hn::ShiftRight<8>(second), place)), byte);
  const V difference = hn::Sub(p1, p2);
  const auto wraps = hn::TestBit(second, hn::Set(d, static_cast<std::int32_t>(SquareNode::kWraps)));
  const V value = hn::IfThenElse(wraps, hn::And(hn::Add(difference, hn::Set(d, 128)), byte), difference);
  const V fails = hn::VecFromMask(d, hn::Lt(value, hn::And(first, byte)));
  const V passes = hn::Add(fails, hn::Set(d, 1));
  const V goes_right = hn::Xor(passes, hn::And(second, hn::Set(d, static_cast<std::int32_t>(SquareNode::kInverted))));
  return hn::GatherIndex(d, words + 2, hn::Add(word, goes_right));
}

/// Steps of all walkers by turns; those that have arrived make room, so that every vector is full but the last.
void walk_together(const Walk& walk, Walkers& walkers) {
  const hn::CappedTag<std::int32_t, Walkers::kSpare> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  while (walkers.count > 0) {
    int walking = 0;
    for (int i = 0; i < walkers.count; i += lanes) {
      const auto patch = hn::LoadU(d, walkers.patch.data() + i);
      const auto present = hn::FirstN(d, static_cast<std::size_t>(walkers.count - i));
      const auto node = hn::IfThenElseZero(present, hn::LoadU(d, walkers.node.data() + i));
      const auto next = next_nodes(d, walk, hn::IfThenElseZero(present, patch), node);
      const auto arrives = hn::And(present, hn::Lt(next, hn::Zero(d)));
      HWY_ALIGN std::int32_t patches[Walkers::kSpare];
      HWY_ALIGN std::int32_t leaves[Walkers::kSpare];
      hn::Store(hn::Compress(patch, arrives), d, patches);
      hn::Store(hn::Compress(hn::Not(next), arrives), d, leaves);
      const std::size_t arrived = hn::CountTrue(d, arrives);
      for (std::size_t a = 0; a < arrived; ++a) walk.leaf_of(patches[a]) = leaves[a];
      const auto stays = hn::AndNot(arrives, present);  // what is stored behind them has been read
      hn::StoreU(hn::Compress(patch, stays), d, walkers.patch.data() + walking);
      hn::StoreU(hn::Compress(next, stays), d, walkers.node.data() + walking);
      walking += static_cast<int>(hn::CountTrue(d, stays));
    }
    walkers.count = walking;
  }
}
#else
void walk_together(const Walk& walk, Walkers& walkers) {
  walk_one_by_one(walk, walkers);
}
#endif

void walk_tree(const SquareForest& forest, int tree, const PatchSquare& square, const std::uint8_t* planes,
               std::int32_t* leaves) {
  const Walk walk{forest, square, planes, leaves};
  Depth a;
  Depth b;
  Walkers walkers;
  const std::uint32_t whole = ~0U >> (kSquareSide - square.width);
  for (int y = 0; y < square.height; ++y) a.rows[y] = {whole, y};
  settle(walk, forest.roots[tree], square.height, a, walkers);
  Depth* from = &a;
  Depth* to = &b;
  while (from->crowd_count > 0) {
    go_deeper(walk, *from, *to, walkers);
    std::swap(from, to);
  }
  walk_together(walk, walkers);
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(walk_tree);

void walk_square(const SquareForest& forest, int tree, const PatchSquare& square,
                 const std::vector<std::uint8_t>& planes, std::int32_t* leaves) {
  HWY_DYNAMIC_DISPATCH(walk_tree)(forest, tree, square, planes.data(), leaves);
}

}  // namespace houghstream
#endif
