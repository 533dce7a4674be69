// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/features/tile_turn.cpp"
#include "detector/features/tile_turn.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

constexpr int kSide = 16;

/// kSide planes of so many pixels as are turned at once; returns how many those were.
HWY_INLINE int turn_blocks(const std::uint8_t* planes, int plane_stride, int count, std::uint8_t* pixels,
                           int pixel_stride) {
#if HWY_TARGET == HWY_SCALAR
  (void)planes, (void)plane_stride, (void)count, (void)pixels, (void)pixel_stride;
  return 0;
#else
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::FixedTag<std::uint8_t, kSide> d;
  using Bytes = hn::Vec<decltype(d)>;
  const int whole = count / kSide * kSide;
  for (int x = 0; x < whole; x += kSide) {
    Bytes rows[kSide];
    for (int i = 0; i < kSide; ++i) rows[i] = hn::LoadU(d, planes + i * plane_stride + x);
    for (int round = 0; round < 4; ++round) {  // each one merges row i with row i + 8
      Bytes merged[kSide];
      for (int i = 0; i < kSide / 2; ++i) {
        merged[2 * i] = hn::InterleaveLower(d, rows[i], rows[i + kSide / 2]);
        merged[2 * i + 1] = hn::InterleaveUpper(d, rows[i], rows[i + kSide / 2]);
      }
      for (int i = 0; i < kSide; ++i) rows[i] = merged[i];
    }
    for (int i = 0; i < kSide; ++i) hn::StoreU(rows[i], d, pixels + (x + i) * pixel_stride);
  }
  return whole;
#endif
}

void turn_row(const std::uint8_t* planes, int plane_stride, int count, std::uint8_t* pixels, int pixel_stride) {
  for (int p = 0; p < pixel_stride; p += kSide, planes += kSide * plane_stride, pixels += kSide) {
    for (int x = turn_blocks(planes, plane_stride, count, pixels, pixel_stride); x < count; ++x) {
      for (int i = 0; i < kSide; ++i) pixels[x * pixel_stride + i] = planes[i * plane_stride + x];
    }
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(turn_row);

void turn_planes(const TileRows& rows, cv::Rect part, FeatureImage& image) {
  for (int y = 0; y < part.height; ++y) {
    HWY_DYNAMIC_DISPATCH(turn_row)
    (rows.row(y, 0), rows.stride(), part.width, image.at(part.x, part.y + y), image.pixel_stride());
  }
}

}  // namespace houghstream
#endif
