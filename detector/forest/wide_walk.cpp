// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/forest/wide_walk.cpp"
#include "detector/forest/wide_walk.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "detector/forest/packed_trees.hpp"

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMost = 256;  // patches that walk together
using Int = hn::CappedTag<std::int32_t, 64>;
using Ints = hn::Vec<Int>;

/// Patches on their way, and what they see at each step.
struct Walkers {
  HWY_ALIGN std::int32_t at[kMost];      // PackedNode
  HWY_ALIGN std::int32_t centre[kMost];  // byte offset of the patch's pixel
  HWY_ALIGN std::int32_t scale[kMost];
  HWY_ALIGN PackedNode nodes[kMost];
  HWY_ALIGN std::int32_t first[kMost];  // byte offsets of what is looked at
  HWY_ALIGN std::int32_t second[kMost];
  HWY_ALIGN std::uint8_t first_values[kMost];
  HWY_ALIGN std::uint8_t second_values[kMost];
  std::size_t count = 0;  // whole vectors
};

/// Which pixels the nodes ask for; as patch_offset.
void find_pixels(const FeatureImage& image, Walkers& w) {
  const Int d;
  const Ints row_stride = hn::Set(d, image.row_stride());
  const Ints pixel_stride = hn::Set(d, image.pixel_stride());
  const Ints half = hn::Set(d, 128);
  for (std::size_t i = 0; i < w.count; i += hn::Lanes(d)) {
    Ints test;
    Ints way;
    hn::LoadInterleaved2(d, reinterpret_cast<const std::int32_t*>(w.nodes + i), test, way);
    const Ints scale = hn::Load(d, w.scale + i);
    const auto to_px = [&](Ints high) {  // of the step in the highest bits
      return hn::ShiftRight<8>(hn::Add(hn::Mul(hn::ShiftRight<32 - packed::kStepBits>(high), scale), half));
    };
    const Ints x1 = to_px(hn::ShiftLeft<27>(test));
    const Ints y1 = to_px(hn::ShiftLeft<22>(test));
    const Ints x2 = to_px(hn::ShiftLeft<17>(test));
    const Ints y2 = to_px(hn::ShiftLeft<12>(test));
    const Ints plane = hn::And(hn::ShiftRight<packed::kPlaneShift>(test), hn::Set(d, 255));
    const Ints start = hn::Add(hn::Load(d, w.centre + i), plane);
    hn::Store(hn::Add(start, hn::Add(hn::Mul(y1, row_stride), hn::Mul(x1, pixel_stride))), d, w.first + i);
    hn::Store(hn::Add(start, hn::Add(hn::Mul(y2, row_stride), hn::Mul(x2, pixel_stride))), d, w.second + i);
  }
}

/// Goes left or right, as find_leaf; those who have arrived stay. Returns whether anyone has moved.
bool take_step(Walkers& w) {
  const Int d;
  const hn::Rebind<std::uint8_t, Int> bytes;
  const Ints alone = hn::Set(d, packed::kAlone);
  const Ints wraps = hn::Set(d, packed::kWraps);
  const Ints child_mask = hn::Set(d, (1 << packed::kLimitShift) - 1);
  Ints moved = hn::Zero(d);
  for (std::size_t i = 0; i < w.count; i += hn::Lanes(d)) {
    Ints test;
    Ints way;
    hn::LoadInterleaved2(d, reinterpret_cast<const std::int32_t*>(w.nodes + i), test, way);
    const Ints p1 = hn::PromoteTo(d, hn::Load(bytes, w.first_values + i));
    const Ints p2 = hn::PromoteTo(d, hn::Load(bytes, w.second_values + i));
    const Ints difference = hn::Sub(p1, hn::IfThenZeroElse(hn::TestBit(test, alone), p2));
    const Ints wrapped = hn::ShiftRight<24>(hn::ShiftLeft<24>(difference));
    const Ints value = hn::IfThenElse(hn::TestBit(test, wraps), wrapped, difference);
    const Ints right = hn::VecFromMask(d, hn::Gt(value, hn::ShiftRight<packed::kLimitShift>(way)));  // -1 or 0
    const Ints next = hn::Sub(hn::And(way, child_mask), right);
    moved = hn::Or(moved, hn::Xor(next, hn::Load(d, w.at + i)));
    hn::Store(next, d, w.at + i);
  }
  return !hn::AllTrue(d, hn::Eq(moved, hn::Zero(d)));
}

/// Puts the patches from `first` on at the root; the last vector is filled with the last patch.
void set_out(const WalkingPatches& patches, std::size_t first, std::int32_t root, Walkers& w) {
  const std::size_t lanes = hn::Lanes(Int());
  const std::size_t last = static_cast<std::size_t>(patches.count) - 1;
  w.count = (std::min(kMost, last + 1 - first) + lanes - 1) / lanes * lanes;
  for (std::size_t i = 0; i < w.count; ++i) {
    const std::size_t p = std::min(first + i, last);
    w.at[i] = root;
    w.centre[i] = patches.y[p] * patches.image->row_stride() + patches.x[p] * patches.image->pixel_stride();
    w.scale[i] = patches.scale[p];
  }
}

void walk(const PackedTrees& trees, int tree, const WalkingPatches& patches, std::int32_t* leaves) {
  const auto count = static_cast<std::size_t>(patches.count);
  const std::uint8_t* origin = patches.image->at(0, 0);
  Walkers w;
  for (std::size_t first = 0; first < count; first += kMost) {
    set_out(patches, first, trees.roots[static_cast<std::size_t>(tree)], w);
    do {
      fetch_nodes(trees.nodes.data(), w.at, w.count, w.nodes);
      find_pixels(*patches.image, w);
      fetch_pixels(origin, w.first, w.second, w.count, w.first_values, w.second_values);
    } while (take_step(w));
    const std::size_t arrived = std::min(kMost, count - first);
    for (std::size_t i = 0; i < arrived; ++i) leaves[first + i] = trees.leaf_of[static_cast<std::size_t>(w.at[i])];
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(walk);

bool walk_wide(const Forest& forest, int tree, const WalkingPatches& patches, std::int32_t* leaves) {
  const auto rows = static_cast<std::int64_t>(patches.image->height()) + 2 * FeatureImage::kPad;
  if (rows * patches.image->row_stride() > INT32_MAX || forest.packed.nodes.empty()) return false;
  HWY_DYNAMIC_DISPATCH(walk)(forest.packed, tree, patches, leaves);
  return true;
}

}  // namespace houghstream
#endif
