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

constexpr std::size_t kMaxBatch = 256;  // patches that are traversed together
using Int = hn::CappedTag<std::int32_t, 64>;
using Ints = hn::Vec<Int>;

/// The patches that have not reached a leaf of the tree, and their values at each level. Behind the last one is space
/// for the rest of its vector.
template <typename T>
using PerPatch = std::array<T, kMaxBatch + hn::MaxLanes(Int())>;
struct ActivePatches {
  PerPatch<std::int32_t> node_index;  // index of the PackedNode
  PerPatch<std::int32_t> patch;       // index of the patch
  PerPatch<std::int32_t> centre;      // byte offset of the patch's pixel
  PerPatch<std::int32_t> scale;
  PerPatch<PackedNode> nodes;
  PerPatch<std::int32_t> test;  // tests of the nodes
  PerPatch<std::int32_t> branch;
  PerPatch<std::int32_t> first;  // byte offset of the test's first pixel
  PerPatch<std::int32_t> second;
  PerPatch<std::uint8_t> first_values;
  PerPatch<std::uint8_t> second_values;
  std::size_t count = 0;
};

/// Some of the patches, at the root.
struct Batch {
  const FeatureImage* image;
  PerPatch<std::int32_t> centre;
  PerPatch<std::int32_t> scale;
  std::size_t count = 0;
};

Batch gather_batch(const PatchBatch& patches, std::size_t first) {
  Batch batch;
  batch.image = patches.image;
  batch.count = std::min(kMaxBatch, static_cast<std::size_t>(patches.count) - first);
  for (std::size_t i = 0; i < batch.count; ++i) {
    const std::size_t p = first + i;
    batch.centre[i] = patches.y[p] * patches.image->row_stride() + patches.x[p] * patches.image->pixel_stride();
    batch.scale[i] = patches.scale[p];
  }
  return batch;
}

void start_batch(const Batch& batch, std::int32_t root, ActivePatches& active) {
  active.count = batch.count;
  active.centre = batch.centre;
  active.scale = batch.scale;
  std::fill_n(active.node_index.begin(), active.count, root);
  std::iota(active.patch.begin(), active.patch.begin() + static_cast<std::ptrdiff_t>(active.count), 0);
}

/// Writes the leaves that some of a vector's patches have reached; `branch` holds their numbers.
HWY_INLINE void retire(hn::Mask<Int> at_leaf, Ints patch, Ints branch, std::int32_t* leaves) {
  const Int d;
  std::array<std::int32_t, hn::MaxLanes(Int())> patches;
  std::array<std::int32_t, hn::MaxLanes(Int())> numbers;
  hn::StoreU(hn::Compress(patch, at_leaf), d, patches.data());
  hn::StoreU(hn::Compress(branch, at_leaf), d, numbers.data());
  const std::size_t count = hn::CountTrue(d, at_leaf);
  for (std::size_t i = 0; i < count; ++i) leaves[patches[i]] = numbers[i];
}

/// Retires the patches that have reached a leaf and compacts the others, so that no lane waits for the deepest path.
void compact(ActivePatches& active, std::int32_t* leaves) {
  const Int d;
  const Ints leaf = hn::Set(d, packed::kLeaf);
  std::size_t left = 0;
  for (std::size_t i = 0; i < active.count; i += hn::Lanes(d)) {
    Ints test;
    Ints branch;
    hn::LoadInterleaved2(d, reinterpret_cast<const std::int32_t*>(active.nodes.data() + i), test, branch);
    const Ints patch = hn::LoadU(d, active.patch.data() + i);
    const Ints centre = hn::LoadU(d, active.centre.data() + i);
    const Ints scale = hn::LoadU(d, active.scale.data() + i);
    const auto present = hn::FirstN(d, active.count - i);
    const auto at_leaf = hn::And(hn::TestBit(test, leaf), present);
    if (hn::AllFalse(d, at_leaf)) {
      hn::StoreU(test, d, active.test.data() + left);
      hn::StoreU(branch, d, active.branch.data() + left);
      if (left != i) {
        hn::StoreU(patch, d, active.patch.data() + left);
        hn::StoreU(centre, d, active.centre.data() + left);
        hn::StoreU(scale, d, active.scale.data() + left);
      }
      left += std::min(hn::Lanes(d), active.count - i);
      continue;
    }
    retire(at_leaf, patch, branch, leaves);
    const auto continues = hn::AndNot(at_leaf, present);  // a store overwrites only lanes that have been read
    hn::StoreU(hn::Compress(test, continues), d, active.test.data() + left);
    hn::StoreU(hn::Compress(branch, continues), d, active.branch.data() + left);
    hn::StoreU(hn::Compress(patch, continues), d, active.patch.data() + left);
    hn::StoreU(hn::Compress(centre, continues), d, active.centre.data() + left);
    hn::StoreU(hn::Compress(scale, continues), d, active.scale.data() + left);
    left += hn::CountTrue(d, continues);
  }
  active.count = left;
}

/// Computes which pixels the nodes test, as patch_offset() does.
void find_pixels(const FeatureImage& image, ActivePatches& active) {
  const Int d;
  const Ints row_stride = hn::Set(d, image.row_stride());
  const Ints pixel_stride = hn::Set(d, image.pixel_stride());
  const Ints half = hn::Set(d, 128);
  for (std::size_t i = 0; i < active.count; i += hn::Lanes(d)) {
    const Ints test = hn::LoadU(d, active.test.data() + i);
    const Ints scale = hn::LoadU(d, active.scale.data() + i);
    const auto to_px = [&](Ints high) {  // pixels of the step in the highest bits
      return hn::ShiftRight<8>(hn::Add(hn::Mul(hn::ShiftRight<32 - packed::kStepBits>(high), scale), half));
    };
    const Ints x1 = to_px(hn::ShiftLeft<27>(test));
    const Ints y1 = to_px(hn::ShiftLeft<22>(test));
    const Ints x2 = to_px(hn::ShiftLeft<17>(test));
    const Ints y2 = to_px(hn::ShiftLeft<12>(test));
    const Ints plane = hn::And(hn::ShiftRight<packed::kPlaneShift>(test), hn::Set(d, 255));
    const Ints start = hn::Add(hn::LoadU(d, active.centre.data() + i), plane);
    const auto place = [&](Ints x, Ints y) {
      return hn::Add(start, hn::Add(hn::Mul(y, row_stride), hn::Mul(x, pixel_stride)));
    };
    hn::StoreU(place(x1, y1), d, active.first.data() + i);
    hn::StoreU(place(x2, y2), d, active.second.data() + i);
  }
}

/// Descends to the left or right child, as find_leaf() does.
void descend(ActivePatches& active) {
  const Int d;
  const hn::Rebind<std::uint8_t, Int> bytes;
  const Ints single_pixel = hn::Set(d, packed::kSinglePixel);
  const Ints wraps = hn::Set(d, packed::kWraps);
  const Ints child_mask = hn::Set(d, (1 << packed::kThresholdShift) - 1);
  for (std::size_t i = 0; i < active.count; i += hn::Lanes(d)) {
    const Ints test = hn::LoadU(d, active.test.data() + i);
    const Ints branch = hn::LoadU(d, active.branch.data() + i);
    const Ints p1 = hn::PromoteTo(d, hn::LoadU(bytes, active.first_values.data() + i));
    const Ints p2 = hn::PromoteTo(d, hn::LoadU(bytes, active.second_values.data() + i));
    const Ints difference = hn::Sub(p1, hn::IfThenZeroElse(hn::TestBit(test, single_pixel), p2));
    const Ints wrapped = hn::ShiftRight<24>(hn::ShiftLeft<24>(difference));
    const Ints value = hn::IfThenElse(hn::TestBit(test, wraps), wrapped, difference);
    const Ints right = hn::VecFromMask(d, hn::Gt(value, hn::ShiftRight<packed::kThresholdShift>(branch)));  // -1 or 0
    hn::StoreU(hn::Sub(hn::And(branch, child_mask), right), d, active.node_index.data() + i);
  }
}

void traverse_tree(const PackedTrees& trees, std::size_t tree, const Batch& batch, ActivePatches& active,
                   std::int32_t* leaves) {
  start_batch(batch, trees.roots[tree], active);
  for (;;) {
    fetch_nodes(trees.nodes.data(), active.node_index.data(), active.count, active.nodes.data());
    compact(active, leaves);
    if (active.count == 0) return;
    find_pixels(*batch.image, active);
    fetch_pixels(batch.image->at(0, 0),
                 {active.first.data(), active.second.data(), active.first_values.data(), active.second_values.data()},
                 active.count);
    descend(active);
  }
}

void traverse(const PackedTrees& trees, TreeRange range, const PatchBatch& patches, std::int32_t* leaves) {
  const auto count = static_cast<std::size_t>(patches.count);
  ActivePatches active;
  for (std::size_t first = 0; first < count; first += kMaxBatch) {
    const Batch batch = gather_batch(patches, first);
    for (std::size_t tree = range.first; tree < range.last; ++tree) {
      traverse_tree(trees, tree, batch, active, leaves + (tree - range.first) * count + first);
    }
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(traverse);

bool traverse_batched(const PackedTrees& packed, TreeRange trees, const PatchBatch& patches, std::int32_t* leaves) {
  const auto rows = static_cast<std::int64_t>(patches.image->height()) + 2 * FeatureImage::kPad;
  if (rows * patches.image->row_stride() > INT32_MAX || packed.nodes.empty()) return false;
  HWY_DYNAMIC_DISPATCH(traverse)(packed, trees, patches, leaves);
  return true;
}

}  // namespace houghstream
#endif
