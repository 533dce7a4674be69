#include "detector/forest/patch_square.hpp"

#include <gtest/gtest.h>

#include "detector/forest/pixel_test.hpp"
#include "detector/forest/square_forest.hpp"

namespace houghstream {
namespace {

TEST(ScaleClasses, AreOneWhereEveryStepIsRoundedAlike) {
  constexpr std::int32_t kLargest = 700;
  for (const int radius : {1, 5, 10}) {
    const ScaleClasses classes(radius, kLargest);
    for (std::int32_t scale = 1; scale <= kLargest; ++scale) {
      bool alike = true;
      for (int step = -radius; step <= radius; ++step) {
        const PatchView a{nullptr, scale - 1, 1000, 1};
        const PatchView b{nullptr, scale, 1000, 1};
        alike = alike && patch_offset(a, step, -step) == patch_offset(b, step, -step);
      }
      EXPECT_EQ(classes[scale - 1] == classes[scale], alike) << "radius " << radius << " scale " << scale;
      EXPECT_LE(classes[scale - 1], classes[scale]);
    }
  }
}

TEST(PatchSquare, HoldsEachPatchInTheGroupOfItsScale) {
  constexpr int kRadius = 5;
  constexpr int kPlanes = 32;
  PatchGrid grid;
  grid.x = {90, 7, 12, 38, 9};  // the first one is another run's
  grid.y = {90, 3, 3, 4, 6};
  grid.scale = {256, 256, 512, 257, 512};
  PatchSquare square;
  for (int round = 0; round < 2; ++round) {  // the second one uses what the first one left
    group_patches(grid, {1, 4}, ScaleClasses(kRadius, 512), kRadius, kPlanes, square);
    EXPECT_EQ(square.left, 7);
    EXPECT_EQ(square.top, 3);
    EXPECT_EQ(square.width, 32);
    EXPECT_EQ(square.height, 4);
    EXPECT_EQ(square.count, 4);
    EXPECT_EQ(square.layout.reach, 10);
    EXPECT_EQ(square.layout.planes, kPlanes);
    ASSERT_EQ(square.group_count, 2U);
    EXPECT_EQ(square.groups[0].rows[0], 1U);
    EXPECT_EQ(square.groups[0].rows[1], 1U << 31);
    EXPECT_EQ(square.groups[1].rows[0], 1U << 5);
    EXPECT_EQ(square.groups[1].rows[3], 1U << 2);
    EXPECT_EQ(square.numbers[0], 0);
    EXPECT_EQ(square.numbers[5], 1);
    EXPECT_EQ(square.numbers[kSquareSide + 31], 2);
    EXPECT_EQ(square.numbers[3 * kSquareSide + 2], 3);
  }
}

TEST(PatchSquare, KnowsThePlaceOfEachStep) {
  constexpr int kRadius = 3;
  PatchGrid grid;
  grid.x = {7};
  grid.y = {3};
  grid.scale = {400};
  PatchSquare square;
  group_patches(grid, {0, 1}, ScaleClasses(kRadius, 400), kRadius, 1, square);
  const SquareLayout& layout = square.layout;
  const PatchView patch{nullptr, 400, layout.row_stride, 1};
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    for (int dx = -kRadius; dx <= kRadius; ++dx) {
      EXPECT_EQ(square.groups[0].places[step_number(dx, dy, kRadius)],
                layout.reach * layout.row_stride + layout.reach + patch_offset(patch, dx, dy));
    }
  }
}

}  // namespace
}  // namespace houghstream
