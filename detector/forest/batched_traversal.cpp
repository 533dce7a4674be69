// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/forest/batched_traversal.cpp"
#include "detector/forest/batched_traversal.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <numeric>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kMax = 256;  // patches that walk together
using Int = hn::CappedTag<std::int32_t, 64>;
using Ints = hn::Vec<Int>;

/// Patches on their way, and what they see at each step. Behind the last one is room for the rest of its vector.
template <typename T>
using PerWalker = std::array<T, kMax + hn::MaxLanes(Int())>;
struct Walkers {
  PerWalker<std::int32_t> at;      // PackedNode
  PerWalker<std::int32_t> who;     // index of the patch
  PerWalker<std::int32_t> centre;  // byte offset of the patch's pixel
  PerWalker<std::int32_t> scale;
  PerWalker<PackedNode> nodes;
  PerWalker<std::int32_t> test;  // tests of the nodes
  PerWalker<std::int32_t> way;
  PerWalker<std::int32_t> first;  // byte offset of the test's first pixel
  PerWalker<std::int32_t> second;
  PerWalker<std::uint8_t> first_values;
  PerWalker<std::uint8_t> second_values;
  std::size_t count = 0;
};

/// Some of the patches, as they set out.
struct Batch {
  const FeatureImage* image;
  PerWalker<std::int32_t> centre;
  PerWalker<std::int32_t> scale;
  std::size_t count = 0;
};

Batch gather_batch(const PatchBatch& patches, std::size_t first) {
  Batch batch;
  batch.image = patches.image;
  batch.count = std::min(kMax, static_cast<std::size_t>(patches.count) - first);
  for (std::size_t i = 0; i < batch.count; ++i) {
    const std::size_t p = first + i;
    batch.centre[i] = patches.y[p] * patches.image->row_stride() + patches.x[p] * patches.image->pixel_stride();
    batch.scale[i] = patches.scale[p];
  }
  return batch;
}

void start(const Batch& batch, std::int32_t root, Walkers& w) {
  w.count = batch.count;
  w.centre = batch.centre;
  w.scale = batch.scale;
  std::fill_n(w.at.begin(), w.count, root);
  std::iota(w.who.begin(), w.who.begin() + static_cast<std::ptrdiff_t>(w.count), 0);
}

/// Notes the leaves that some of a vector's patches have reached; `way` holds their numbers.
HWY_INLINE void retire(hn::Mask<Int> arrived, Ints who, Ints way, std::int32_t* leaves) {
  const Int d;
  std::array<std::int32_t, hn::MaxLanes(Int())> patches;
  std::array<std::int32_t, hn::MaxLanes(Int())> numbers;
  hn::StoreU(hn::Compress(who, arrived), d, patches.data());
  hn::StoreU(hn::Compress(way, arrived), d, numbers.data());
  const std::size_t count = hn::CountTrue(d, arrived);
  for (std::size_t i = 0; i < count; ++i) leaves[patches[i]] = numbers[i];
}

/// Patches that have reached a leaf are retired and the others compacted, so that no lane waits for the deepest path.
void compact(Walkers& w, std::int32_t* leaves) {
  const Int d;
  const Ints leaf = hn::Set(d, packed::kLeaf);
  std::size_t left = 0;
  for (std::size_t i = 0; i < w.count; i += hn::Lanes(d)) {
    Ints test;
    Ints way;
    hn::LoadInterleaved2(d, reinterpret_cast<const std::int32_t*>(w.nodes.data() + i), test, way);
    const Ints who = hn::LoadU(d, w.who.data() + i);
    const Ints centre = hn::LoadU(d, w.centre.data() + i);
    const Ints scale = hn::LoadU(d, w.scale.data() + i);
    const auto present = hn::FirstN(d, w.count - i);
    const auto arrived = hn::And(hn::TestBit(test, leaf), present);
    if (hn::AllFalse(d, arrived)) {
      hn::StoreU(test, d, w.test.data() + left);
      hn::StoreU(way, d, w.way.data() + left);
      if (left != i) {
        hn::StoreU(who, d, w.who.data() + left);
        hn::StoreU(centre, d, w.centre.data() + left);
        hn::StoreU(scale, d, w.scale.data() + left);
      }
      left += std::min(hn::Lanes(d), w.count - i);
      continue;
    }
    retire(arrived, who, way, leaves);
    const auto stays = hn::AndNot(arrived, present);  // a store overwrites only lanes that have been read
    hn::StoreU(hn::Compress(test, stays), d, w.test.data() + left);
    hn::StoreU(hn::Compress(way, stays), d, w.way.data() + left);
    hn::StoreU(hn::Compress(who, stays), d, w.who.data() + left);
    hn::StoreU(hn::Compress(centre, stays), d, w.centre.data() + left);
    hn::StoreU(hn::Compress(scale, stays), d, w.scale.data() + left);
    left += hn::CountTrue(d, stays);
  }
  w.count = left;
}

/// Computes which pixels the nodes ask for, as patch_offset does.
void find_pixels(const FeatureImage& image, Walkers& w) {
  const Int d;
  const Ints row_stride = hn::Set(d, image.row_stride());
  const Ints pixel_stride = hn::Set(d, image.pixel_stride());
  const Ints half = hn::Set(d, 128);
  for (std::size_t i = 0; i < w.count; i += hn::Lanes(d)) {
    const Ints test = hn::LoadU(d, w.test.data() + i);
    const Ints scale = hn::LoadU(d, w.scale.data() + i);
    const auto to_px = [&](Ints high) {  // pixels of the step in the highest bits
      return hn::ShiftRight<8>(hn::Add(hn::Mul(hn::ShiftRight<32 - packed::kStepBits>(high), scale), half));
    };
    const Ints x1 = to_px(hn::ShiftLeft<27>(test));
    const Ints y1 = to_px(hn::ShiftLeft<22>(test));
    const Ints x2 = to_px(hn::ShiftLeft<17>(test));
    const Ints y2 = to_px(hn::ShiftLeft<12>(test));
    const Ints plane = hn::And(hn::ShiftRight<packed::kPlaneShift>(test), hn::Set(d, 255));
    const Ints start = hn::Add(hn::LoadU(d, w.centre.data() + i), plane);
    const auto place = [&](Ints x, Ints y) {
      return hn::Add(start, hn::Add(hn::Mul(y, row_stride), hn::Mul(x, pixel_stride)));
    };
    hn::StoreU(place(x1, y1), d, w.first.data() + i);
    hn::StoreU(place(x2, y2), d, w.second.data() + i);
  }
}

/// Goes left or right, as find_leaf.
void take_step(Walkers& w) {
  const Int d;
  const hn::Rebind<std::uint8_t, Int> bytes;
  const Ints alone = hn::Set(d, packed::kSinglePixel);
  const Ints wraps = hn::Set(d, packed::kWraps);
  const Ints child_mask = hn::Set(d, (1 << packed::kLimitShift) - 1);
  for (std::size_t i = 0; i < w.count; i += hn::Lanes(d)) {
    const Ints test = hn::LoadU(d, w.test.data() + i);
    const Ints way = hn::LoadU(d, w.way.data() + i);
    const Ints p1 = hn::PromoteTo(d, hn::LoadU(bytes, w.first_values.data() + i));
    const Ints p2 = hn::PromoteTo(d, hn::LoadU(bytes, w.second_values.data() + i));
    const Ints difference = hn::Sub(p1, hn::IfThenZeroElse(hn::TestBit(test, alone), p2));
    const Ints wrapped = hn::ShiftRight<24>(hn::ShiftLeft<24>(difference));
    const Ints value = hn::IfThenElse(hn::TestBit(test, wraps), wrapped, difference);
    const Ints right = hn::VecFromMask(d, hn::Gt(value, hn::ShiftRight<packed::kLimitShift>(way)));  // -1 or 0
    hn::StoreU(hn::Sub(hn::And(way, child_mask), right), d, w.at.data() + i);
  }
}

void walk_tree(const PackedTrees& trees, std::size_t tree, const Batch& batch, Walkers& w, std::int32_t* leaves) {
  start(batch, trees.roots[tree], w);
  for (;;) {
    fetch_nodes(trees.nodes.data(), w.at.data(), w.count, w.nodes.data());
    compact(w, leaves);
    if (w.count == 0) return;
    find_pixels(*batch.image, w);
    fetch_pixels(batch.image->at(0, 0),
                 {w.first.data(), w.second.data(), w.first_values.data(), w.second_values.data()}, w.count);
    take_step(w);
  }
}

void walk(const PackedTrees& trees, TreeRange range, const PatchBatch& patches, std::int32_t* leaves) {
  const auto count = static_cast<std::size_t>(patches.count);
  Walkers w;
  for (std::size_t first = 0; first < count; first += kMax) {
    const Batch batch = gather_batch(patches, first);
    for (std::size_t tree = range.first; tree < range.last; ++tree) {
      walk_tree(trees, tree, batch, w, leaves + (tree - range.first) * count + first);
    }
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(walk);

bool traverse_batched(const PackedTrees& packed, TreeRange trees, const PatchBatch& patches, std::int32_t* leaves) {
  const auto rows = static_cast<std::int64_t>(patches.image->height()) + 2 * FeatureImage::kPad;
  if (rows * patches.image->row_stride() > INT32_MAX || packed.nodes.empty()) return false;
  HWY_DYNAMIC_DISPATCH(walk)(packed, trees, patches, leaves);
  return true;
}

}  // namespace houghstream
#endif
