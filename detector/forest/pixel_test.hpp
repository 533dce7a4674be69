#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "detector/features/feature_image.hpp"
#include "detector/features/patch_settings.hpp"

namespace houghstream {

/// p1 - p2 >= threshold on one feature plane (Gall et al. 2011). Offsets are in steps of PatchSettings::unit on the
/// object: the pixel offset is the step times the patch's scale, so that an object is tested alike at every distance
/// (depth normalisation, paper Section 5.1.2).
struct PixelTest {
  static constexpr std::uint8_t kDifference = 0;
  static constexpr std::uint8_t kWrapping = 24;      ///< the difference is taken modulo 256: bits to shift out
  static constexpr std::uint8_t kSinglePixel = 128;  ///< p1 alone, where p2 counts as 0: which colour, which slope

  std::int8_t dx1 = 0;
  std::int8_t dy1 = 0;
  std::int8_t dx2 = 0;
  std::int8_t dy2 = 0;
  std::uint8_t plane = 0;
  std::uint8_t kind = kDifference;
  std::int16_t threshold = 0;
};

/// Bytes from a patch's centre to the pixel `dx`, `dy` steps away.
inline std::ptrdiff_t patch_offset(const PatchView& patch, int dx, int dy) {
  const int x_px = (dx * patch.scale + 128) >> 8;
  const int y_px = (dy * patch.scale + 128) >> 8;
  return static_cast<std::ptrdiff_t>(y_px) * patch.row_stride + x_px * patch.pixel_stride;
}

/// Returns p1 - p2. SplitSearch is the other place that reads patches.
inline int test_value(const PixelTest& test, const PatchView& patch) {
  const auto offset = [&](std::int8_t dx, std::int8_t dy) { return patch_offset(patch, dx, dy) + test.plane; };
  const int second_mask = (test.kind >> 7) - 1;
  const int difference =
      patch.centre[offset(test.dx1, test.dy1)] - (patch.centre[offset(test.dx2, test.dy2)] & second_mask);
  const int shift = test.kind & 31;
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(difference) << shift) >> shift;
}

}  // namespace houghstream
