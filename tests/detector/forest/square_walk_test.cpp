#include "detector/forest/square_walk.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "detector/forest/square_planes.hpp"
#include "tests/detector/forest/random_forest.hpp"

namespace houghstream {
namespace {

constexpr std::int32_t kNobody = -77;

/// Patches at some of a square's places, with one of the scales each.
PatchGrid patches_in(cv::Rect box, double share, const std::vector<std::int32_t>& scales, Random& random) {
  PatchGrid grid;
  for (int i = 0; i < box.area(); ++i) {
    if (i > 0 && random.uniform() >= share) continue;
    grid.x.push_back(static_cast<std::int16_t>(box.x + i % box.width));
    grid.y.push_back(static_cast<std::int16_t>(box.y + i / box.width));
    grid.scale.push_back(scales[static_cast<std::size_t>(random.below(static_cast<int>(scales.size())))]);
  }
  return grid;
}

void expect_leaves_of_find_leaf(const Forest& forest, const FeatureImage& image, const PatchGrid& grid) {
  const SquareForest ready(forest);
  const int radius = forest.patch.radius;
  PatchSquare square;
  group_patches(grid, {0, grid.size()}, ScaleClasses(radius, limited_scale(forest.patch, 1000.0)), radius,
                image.pixel_stride(), square);
  std::vector<std::uint8_t> planes(1, 7);
  copy_planes(image, square, planes);
  const std::size_t trees = forest.roots.size();
  std::vector<std::int32_t> leaves(trees * grid.size() + 1, kNobody);
  walk_square(ready, static_cast<int>(trees), square, planes, leaves.data());
  for (std::size_t i = 0; i + 1 < leaves.size(); ++i) {
    const std::size_t p = i % grid.size();
    const int tree = static_cast<int>(i / grid.size());
    const PatchView patch = image.patch(grid.x[p], grid.y[p], grid.scale[p]);
    ASSERT_EQ(leaves[i], find_leaf(forest, tree, patch)) << "tree " << tree << " patch " << p;
  }
  EXPECT_EQ(leaves.back(), kNobody);
}

/// What the processor can do, one instruction set at a time.
class SquareWalk : public ::testing::Test {
 protected:
  void TearDown() override { use(0); }

  static void use(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // the next call chooses anew
  }
};

TEST_F(SquareWalk, EveryInstructionSetReachesTheLeavesOfFindLeaf) {
  Random random(21);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    use(target);
    for (const int planes : {32, 64, 256}) {
      const FeatureImage image = chance::random_image(75, 50, planes, random);
      const Forest forest = chance::random_forest(planes, random);
      for (const std::int32_t scale : {limited_scale(forest.patch, 1000.0), 256, 77}) {
        expect_leaves_of_find_leaf(forest, image, patches_in({32, 0, 32, 32}, 1.0, {scale}, random));
        // the lower right corner
        expect_leaves_of_find_leaf(forest, image, patches_in({64, 32, 11, 18}, 1.0, {scale}, random));
      }
    }
  }
}

TEST_F(SquareWalk, SquaresOfAnySizeAreWalked) {
  Random random(22);
  const FeatureImage image = chance::random_image(40, 40, 32, random);
  const Forest forest = chance::random_forest(32, random);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    use(target);
    for (int side = 1; side <= kSquareSide; ++side) {
      expect_leaves_of_find_leaf(forest, image, patches_in({0, 3, side, 1 + side / 2}, 1.0, {256}, random));
      expect_leaves_of_find_leaf(forest, image, patches_in({5, 0, 1 + side / 3, side}, 1.0, {256}, random));
    }
  }
}

TEST_F(SquareWalk, APictureOfOneColourStaysTogether) {
  Random random(23);
  FeatureImage image(40, 40, 32);
  const Forest forest = chance::random_forest(32, random);
  expect_leaves_of_find_leaf(forest, image, patches_in({4, 4, 32, 32}, 1.0, {256}, random));
}

TEST_F(SquareWalk, PatchesOfManyScalesAndWithGapsAreWalked) {
  Random random(24);
  const FeatureImage image = chance::random_image(40, 40, 32, random);
  const Forest forest = chance::random_forest(32, random);
  const std::int32_t widest = limited_scale(forest.patch, 1000.0);
  std::vector<std::int32_t> all;
  for (std::int32_t scale = 1; scale <= widest; ++scale) all.push_back(scale);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    use(target);
    for (const double share : {0.0, 0.01, 0.3, 0.9}) {
      expect_leaves_of_find_leaf(forest, image, patches_in({8, 8, 32, 32}, share, {300, 200, 205}, random));
      expect_leaves_of_find_leaf(forest, image, patches_in({0, 8, 32, 32}, share, all, random));
    }
  }
}

}  // namespace
}  // namespace houghstream
