// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/forest/wide_walk.cpp"
#include "detector/forest/wide_walk.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A node as four 32-bit words is what the gathers below rely on.
static_assert(sizeof(TreeNode) == 16 && sizeof(PixelTest) == 8 && offsetof(TreeNode, left) == 8 &&
              offsetof(TreeNode, right) == 12);

using Int = hn::ScalableTag<std::int32_t>;
using Ints = hn::Vec<Int>;

/// The pixels that one image offers to gathers.
struct Pixels {
  const std::int32_t* origin;  // of pixel (0,0); byte offsets from here
  Ints row_stride;
  Ints pixel_stride;
};

/// Where one vector of patches stands.
struct Walkers {
  Ints centre;  // byte offset of each patch's pixel
  Ints scale;
  Ints at;  // node, or -1 - leaf
};

template <int kShift>
HWY_INLINE Ints signed_byte(Ints word) {
  return hn::ShiftRight<24>(hn::ShiftLeft<24 - kShift>(word));
}

HWY_INLINE Ints offset_of(Ints dx, Ints dy, const Walkers& w, const Pixels& pixels) {
  const Int d;
  const Ints half = hn::Set(d, 128);
  const Ints x_px = hn::ShiftRight<8>(hn::Add(hn::Mul(dx, w.scale), half));
  const Ints y_px = hn::ShiftRight<8>(hn::Add(hn::Mul(dy, w.scale), half));
  return hn::Add(hn::Mul(y_px, pixels.row_stride), hn::Mul(x_px, pixels.pixel_stride));
}

/// One test for every walker that has not arrived; as test_value and find_leaf.
HWY_INLINE void take_step(const TreeNode* nodes, const Pixels& pixels, Walkers& w) {
  const Int d;
  const auto arrived = hn::Lt(w.at, hn::Zero(d));
  const Ints node = hn::ShiftLeft<4>(hn::IfThenZeroElse(arrived, w.at));
  const auto* words = reinterpret_cast<const std::int32_t*>(nodes);
  const Ints places = hn::GatherOffset(d, words, node);
  const Ints rule = hn::GatherOffset(d, words + 1, node);
  const Ints byte = hn::Set(d, 255);
  const Ints plane = hn::Add(hn::And(rule, byte), w.centre);
  const Ints first = hn::Add(plane, offset_of(signed_byte<0>(places), signed_byte<8>(places), w, pixels));
  const Ints second = hn::Add(plane, offset_of(signed_byte<16>(places), hn::ShiftRight<24>(places), w, pixels));
  const Ints kind = hn::And(hn::ShiftRight<8>(rule), byte);
  const auto alone = hn::Eq(kind, hn::Set(d, PixelTest::kAlone));
  const auto wraps = hn::Eq(kind, hn::Set(d, PixelTest::kWrapping));
  const Ints p1 = hn::And(hn::GatherOffset(d, pixels.origin, first), byte);
  const Ints p2 = hn::And(hn::GatherOffset(d, pixels.origin, second), byte);
  const Ints difference = hn::Sub(p1, hn::IfThenZeroElse(alone, p2));
  const Ints value = hn::IfThenElse(wraps, signed_byte<0>(difference), difference);
  const auto left = hn::Lt(value, hn::ShiftRight<16>(rule));
  const Ints child = hn::IfThenElse(left, hn::Set(d, offsetof(TreeNode, left)), hn::Set(d, offsetof(TreeNode, right)));
  const Ints next = hn::GatherOffset(d, words, hn::Add(node, child));
  w.at = hn::IfThenElse(arrived, w.at, next);
}

HWY_INLINE bool all_arrived(const Walkers& w) {
  const Int d;
  return hn::AllTrue(d, hn::Lt(w.at, hn::Zero(d)));
}

constexpr std::size_t kMaxLanes = 64;

bool walk(const Forest& forest, int tree, const WalkingPatches& patches, std::int32_t* leaves) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2  // better targets have lower numbers
  const Int d;
  const std::size_t lanes = hn::Lanes(d);
  constexpr std::size_t kVectors = 4;  // in flight, so that their cache misses overlap
  const Pixels pixels{reinterpret_cast<const std::int32_t*>(patches.image->at(0, 0)),
                      hn::Set(d, patches.image->row_stride()), hn::Set(d, patches.image->pixel_stride())};
  const auto count = static_cast<std::size_t>(patches.count);
  for (std::size_t begin = 0; begin < count; begin += kVectors * lanes) {
    HWY_ALIGN std::int32_t centre[kVectors * kMaxLanes];
    HWY_ALIGN std::int32_t scale[kVectors * kMaxLanes];
    for (std::size_t i = 0; i < kVectors * lanes; ++i) {
      const std::size_t p = begin + i < count ? begin + i : count - 1;  // the last one again where there are no more
      centre[i] = patches.y[p] * patches.image->row_stride() + patches.x[p] * patches.image->pixel_stride();
      scale[i] = patches.scale[p];
    }
    const Ints root = hn::Set(d, forest.roots[static_cast<std::size_t>(tree)]);
    Walkers a{hn::Load(d, centre), hn::Load(d, scale), root};
    Walkers b{hn::Load(d, centre + lanes), hn::Load(d, scale + lanes), root};
    Walkers c{hn::Load(d, centre + 2 * lanes), hn::Load(d, scale + 2 * lanes), root};
    Walkers e{hn::Load(d, centre + 3 * lanes), hn::Load(d, scale + 3 * lanes), root};
    while (!(all_arrived(a) && all_arrived(b) && all_arrived(c) && all_arrived(e))) {
      take_step(forest.nodes.data(), pixels, a);
      take_step(forest.nodes.data(), pixels, b);
      take_step(forest.nodes.data(), pixels, c);
      take_step(forest.nodes.data(), pixels, e);
    }
    hn::Store(a.at, d, centre);
    hn::Store(b.at, d, centre + lanes);
    hn::Store(c.at, d, centre + 2 * lanes);
    hn::Store(e.at, d, centre + 3 * lanes);
    for (std::size_t i = 0; i < kVectors * lanes && begin + i < count; ++i) leaves[begin + i] = -1 - centre[i];
  }
  return true;
#else
  (void)forest, (void)tree, (void)patches, (void)leaves;
  return false;
#endif
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(walk);

bool walk_wide(const Forest& forest, int tree, const WalkingPatches& patches, std::int32_t* leaves) {
  const auto rows = static_cast<std::int64_t>(patches.image->height()) + 2 * FeatureImage::kPad;
  if (rows * patches.image->row_stride() > INT32_MAX || forest.nodes.empty()) return false;
  if (forest.nodes.size() > static_cast<std::size_t>(INT32_MAX) / sizeof(TreeNode)) return false;
  return HWY_DYNAMIC_DISPATCH(walk)(forest, tree, patches, leaves);
}

}  // namespace houghstream
#endif
