#include "detector/features/tile_extremes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace houghstream {
namespace {

constexpr int kWidth = 40;
constexpr int kHeight = 6;

/// 9 everywhere but 200 at (20,3), and what lies around the part counts too.
template <typename T>
TilePlane<T> plane_with_a_peak(T peak, int margin) {
  TilePlane<T> plane;
  plane.reset({kWidth, kHeight}, margin);
  for (int y = -margin; y < kHeight + margin; ++y) std::fill_n(plane.row(y) - margin, kWidth + 2 * margin, T{9});
  plane.row(3)[20] = peak;
  plane.row(-1)[-1] = 0;
  return plane;
}

TEST(TileExtremes, ReachHalfTheSideAndFartherLeftWhereItIsEven) {
  const TilePlane<std::uint8_t> plane = plane_with_a_peak<std::uint8_t>(200, 3);
  TileRows rows;
  rows.reset({kWidth, kHeight}, 2);
  byte_extremes(plane, {5}, {0, 1}, rows);
  EXPECT_EQ(rows.row(3, 0)[18], 200);
  EXPECT_EQ(rows.row(3, 0)[22], 200);
  EXPECT_EQ(rows.row(1, 0)[20], 200);
  EXPECT_EQ(rows.row(3, 0)[17], 9);
  EXPECT_EQ(rows.row(3, 1)[20], 9);
  EXPECT_EQ(rows.row(1, 1)[1], 0);
  EXPECT_EQ(rows.row(2, 1)[1], 9);
  byte_extremes(plane, {4}, {0, 1}, rows);
  EXPECT_EQ(rows.row(3, 0)[22], 200);
  EXPECT_EQ(rows.row(3, 0)[19], 200);
  EXPECT_EQ(rows.row(3, 0)[18], 9);
}

TEST(TileExtremes, StepsBecomeBytesAfterwards) {
  const TilePlane<std::uint16_t> plane = plane_with_a_peak<std::uint16_t>(300, 1);
  TileRows rows;
  rows.reset({kWidth, kHeight}, 2);
  step_extremes(plane, {3}, StepBytes::kWrapped, {0, 1}, rows);
  EXPECT_EQ(rows.row(3, 0)[21], 300 - 256);
  EXPECT_EQ(rows.row(3, 1)[21], 9);
  step_extremes(plane, {3}, StepBytes::kLimited, {0, 1}, rows);
  EXPECT_EQ(rows.row(3, 0)[21], 255);
}

}  // namespace
}  // namespace houghstream
