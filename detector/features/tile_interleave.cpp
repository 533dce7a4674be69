// Compiled once for each instruction set, see foreach_target.h of Highway.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detector/features/tile_interleave.cpp"
#include "detector/features/tile_interleave.hpp"

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace houghstream::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kTurnSide = 16;  // bytes of a block of a vector

/// Turns squares of kTurnSide x kTurnSide bytes about their diagonal: byte j of row i becomes byte i of row j, in each
/// block of the vectors of tag `d`.
template <class D>
HWY_INLINE void transpose_bytes(D d, hn::Vec<D> (&rows)[kTurnSide]) {
  for (int round = 0; round < 4; ++round) {  // each one merges row i with row i + 8
    hn::Vec<D> merged[kTurnSide];
    for (int i = 0; i < kTurnSide / 2; ++i) {
      merged[2 * i] = hn::InterleaveLower(d, rows[i], rows[i + kTurnSide / 2]);
      merged[2 * i + 1] = hn::InterleaveUpper(d, rows[i], rows[i + kTurnSide / 2]);
    }
    for (int i = 0; i < kTurnSide; ++i) rows[i] = merged[i];
  }
}

/// Interleaves the bytes of kTurnSide planes, then those of the kTurnSide planes that follow, ...
template <std::size_t kSize>
HWY_INLINE hn::Vec<hn::FixedTag<std::uint8_t, kSize>> load_blocks(const std::uint8_t* planes, int plane_stride) {
  const hn::FixedTag<std::uint8_t, kSize> d;
  if constexpr (kSize == kTurnSide) {
    return hn::LoadU(d, planes);
  } else {
    return hn::Combine(d, load_blocks<kSize / 2>(planes + kSize / 2 * plane_stride, plane_stride),
                       load_blocks<kSize / 2>(planes, plane_stride));
  }
}

/// Transposes kSize planes of kTurnSide pixels: kTurnSide planes to a block, all blocks at once. Whole cache lines go
/// past the cache, into which they would first have to be read.
template <std::size_t kSize>
HWY_INLINE void transpose_block(const std::uint8_t* planes, int plane_stride, std::uint8_t* pixels, int pixel_stride) {
  constexpr std::size_t kLine = 64;
  const hn::FixedTag<std::uint8_t, kSize> d;
  hn::Vec<decltype(d)> rows[kTurnSide];
  for (int i = 0; i < kTurnSide; ++i) rows[i] = load_blocks<kSize>(planes + i * plane_stride, plane_stride);
  transpose_bytes(d, rows);
  const bool whole_lines =
      kSize == kLine && pixel_stride % kLine == 0 && reinterpret_cast<std::uintptr_t>(pixels) % kLine == 0;
  for (int i = 0; i < kTurnSide; ++i) {
    if (whole_lines) {
      hn::Stream(rows[i], d, pixels + i * pixel_stride);
    } else {
      hn::StoreU(rows[i], d, pixels + i * pixel_stride);
    }
  }
}

#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3  // better targets have lower numbers
constexpr int kTransposed = 64;
#elif HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
constexpr int kTransposed = 32;
#else
constexpr int kTransposed = kTurnSide;
#endif

/// Returns how many pixels were turned, from the first one on.
int transpose_whole_blocks(const std::uint8_t* planes, int plane_stride, int count, std::uint8_t* pixels,
                           int pixel_stride) {
  const int whole = count / kTurnSide * kTurnSide;
  for (int x = 0; x < whole; x += kTurnSide) {
    int p = 0;
    for (; p + kTransposed <= pixel_stride; p += kTransposed) {
      transpose_block<kTransposed>(planes + p * plane_stride + x, plane_stride, pixels + x * pixel_stride + p,
                                   pixel_stride);
    }
    for (; p < pixel_stride; p += kTurnSide) {
      transpose_block<kTurnSide>(planes + p * plane_stride + x, plane_stride, pixels + x * pixel_stride + p,
                                 pixel_stride);
    }
  }
  return whole;
}
#else
int transpose_whole_blocks(const std::uint8_t*, int, int, std::uint8_t*, int) {
  return 0;
}
#endif

void transpose_row(const std::uint8_t* planes, int plane_stride, int count, std::uint8_t* pixels, int pixel_stride) {
  for (int x = transpose_whole_blocks(planes, plane_stride, count, pixels, pixel_stride); x < count; ++x) {
    for (int p = 0; p < pixel_stride; ++p) pixels[x * pixel_stride + p] = planes[p * plane_stride + x];
  }
}

}  // namespace houghstream::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace houghstream {

HWY_EXPORT(transpose_row);

void interleave_planes(const TileRows& rows, cv::Rect part, FeatureImage& image) {
  for (int y = 0; y < part.height; ++y) {
    HWY_DYNAMIC_DISPATCH(transpose_row)
    (rows.row(y, 0), rows.stride(), part.width, image.at(part.x, part.y + y), image.pixel_stride());
  }
  hwy::FlushStream();  // before other threads read
}

}  // namespace houghstream
#endif
