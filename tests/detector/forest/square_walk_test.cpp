#include "detector/forest/square_walk.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "random_forest.hpp"

namespace houghstream {
namespace {

constexpr std::int32_t kNobody = -77;

void expect_leaves_of_find_leaf(const Forest& forest, const FeatureImage& image, const PatchSquare& square,
                                std::int32_t scale) {
  const SquareForest ready(forest, scale, image.pixel_stride());
  std::vector<std::uint8_t> planes(1, 7);
  copy_planes(image, square, ready.layout, planes);
  for (int tree = 0; tree < static_cast<int>(forest.roots.size()); ++tree) {
    const int count = square.width * square.height;
    std::vector<std::int32_t> leaves(static_cast<std::size_t>(count) + 1, kNobody);
    walk_square(ready, tree, square, planes, leaves.data());
    for (int i = 0; i < count; ++i) {
      const PatchView patch = image.patch(square.left + i % square.width, square.top + i / square.width, scale);
      ASSERT_EQ(leaves[static_cast<std::size_t>(i)], find_leaf(forest, tree, patch))
          << "tree " << tree << " patch " << i;
    }
    EXPECT_EQ(leaves.back(), kNobody);
  }
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
        expect_leaves_of_find_leaf(forest, image, {32, 0, 32, 32}, scale);
        expect_leaves_of_find_leaf(forest, image, {64, 32, 11, 18}, scale);  // the lower right corner
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
      expect_leaves_of_find_leaf(forest, image, {0, 3, side, 1 + side / 2}, 256);
      expect_leaves_of_find_leaf(forest, image, {5, 0, 1 + side / 3, side}, 256);
    }
  }
}

TEST_F(SquareWalk, APictureOfOneColourStaysTogether) {
  Random random(23);
  FeatureImage image(40, 40, 32);
  const Forest forest = chance::random_forest(32, random);
  expect_leaves_of_find_leaf(forest, image, {4, 4, 32, 32}, 256);
}

}  // namespace
}  // namespace houghstream
