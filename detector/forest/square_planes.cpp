// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/forest/square_planes.cpp"
#include "detector/forest/square_planes.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "detector/features/tiles/byte_turn-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

/// Pixels to planes, in steps of as many as are turned at once; returns how many pixels that were.
HWY_INLINE int turn_blocks(const std::uint8_t* pixels, int count, int pixel_stride, const SquareLayout& layout,
                           std::uint8_t* out) {
#if HWY_TARGET == HWY_SCALAR
  (void)pixels, (void)count, (void)pixel_stride, (void)layout, (void)out;
  return 0;
#else
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::FixedTag<std::uint8_t, kTurnSide> d;
  if (layout.planes % kTurnSide != 0 || count < kTurnSide) return 0;
  for (int next = 0; next < count; next += kTurnSide) {
    const int x = std::min(next, count - kTurnSide);  // the last ones may be turned twice
    for (int p = 0; p < layout.planes; p += kTurnSide) {
      hn::Vec<decltype(d)> rows[kTurnSide];
      for (int i = 0; i < kTurnSide; ++i) rows[i] = hn::LoadU(d, pixels + (x + i) * pixel_stride + p);
      turn_bytes(d, rows);
      for (int i = 0; i < kTurnSide; ++i) hn::StoreU(rows[i], d, out + (p + i) * layout.plane_stride + x);
    }
  }
  return count;
#endif
}

void copy_row(const std::uint8_t* pixels, int count, int pixel_stride, const SquareLayout& layout, std::uint8_t* out) {
  for (int x = turn_blocks(pixels, count, pixel_stride, layout, out); x < count; ++x) {
    for (int p = 0; p < layout.planes; ++p) out[p * layout.plane_stride + x] = pixels[x * pixel_stride + p];
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(copy_row);

void copy_planes(const FeatureImage& image, const PatchSquare& square, std::vector<std::uint8_t>& planes) {
  const SquareLayout& layout = square.layout;
  planes.resize(layout.size());
  std::fill_n(planes.begin() + layout.planes * layout.plane_stride, layout.plane_stride, std::uint8_t{0});
  for (int y = 0; y < square.height + 2 * layout.reach; ++y) {
    HWY_DYNAMIC_DISPATCH(copy_row)
    (image.at(square.left - layout.reach, square.top - layout.reach + y), square.width + 2 * layout.reach,
     image.pixel_stride(), layout, planes.data() + y * layout.row_stride);
  }
}

}  // namespace houghstream
#endif
