#include "detector/forest/wide_walk.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "pipeline/random.hpp"

namespace houghstream {
namespace {

const PatchSettings kPatch;
constexpr std::int32_t kNobody = -77;

/// Random bytes in every plane, in the border and behind the last pixel's planes too.
FeatureImage random_image(int pixel_stride, Random& random) {
  FeatureImage image(21, 13, pixel_stride);
  for (int y = -FeatureImage::kPad; y < image.height() + FeatureImage::kPad; ++y) {
    std::uint8_t* row = image.at(-FeatureImage::kPad, y);
    for (int i = 0; i < image.row_stride(); ++i) row[i] = static_cast<std::uint8_t>(random.below(256));
  }
  return image;
}

PixelTest random_test(int planes, Random& random) {
  constexpr std::uint8_t kKinds[] = {PixelTest::kDifference, PixelTest::kWrapping, PixelTest::kAlone};
  const auto step = [&] { return static_cast<std::int8_t>(random.between(-kPatch.radius, kPatch.radius)); };
  PixelTest test{step(), step(), step(), step(), 0, kKinds[random.below(3)], 0};
  test.plane = static_cast<std::uint8_t>(random.uniform() < 0.2 ? planes - 1 : random.below(planes));
  const int middle = test.kind == PixelTest::kAlone ? 128 : 0;
  test.threshold = static_cast<std::int16_t>(middle + random.between(-60, 60));
  return test;
}

/// Two grown trees, the second one behind the first, and between them one that is a leaf.
Forest random_forest(int planes, Random& random) {
  Forest forest;
  std::int32_t leaves = 0;
  for (const int size : {200, 0, 60}) {
    const auto first = static_cast<std::int32_t>(forest.nodes.size());
    forest.roots.push_back(size > 0 ? first : -1 - leaves++);
    std::int32_t unused = first + 1;
    for (int n = 0; n < size; ++n) {
      TreeNode node{random_test(planes, random), 0, 0};
      for (std::int32_t* child : {&node.left, &node.right}) {
        const bool must_grow = unused == first + n + 1 && child == &node.right;  // else the tree would end here
        const bool grows = unused < first + size && (must_grow || random.uniform() < 0.7);
        *child = grows ? unused++ : -1 - leaves++;
      }
      forest.nodes.push_back(node);
    }
  }
  return forest;
}

/// The image's corners with the widest patches, then anything.
struct Patches {
  std::vector<std::int16_t> x;
  std::vector<std::int16_t> y;
  std::vector<std::int32_t> scale;
};

Patches random_patches(const FeatureImage& image, int count, Random& random) {
  Patches patches;
  const std::int32_t widest = limited_scale(kPatch, 1000.0);
  for (int i = 0; i < count; ++i) {
    const bool corner = i < 4;
    const int right = image.width() - 1;
    const int bottom = image.height() - 1;
    patches.x.push_back(static_cast<std::int16_t>(corner ? i % 2 * right : random.between(0, right)));
    patches.y.push_back(static_cast<std::int16_t>(corner ? i / 2 * bottom : random.between(0, bottom)));
    patches.scale.push_back(corner ? widest : random.between(1, widest));
  }
  return patches;
}

/// Compares the walk of all patches with find_leaf, and says whether there was one.
bool walks_like_find_leaf(const Forest& forest, const FeatureImage& image, const Patches& patches, std::size_t step) {
  const auto count = static_cast<int>(patches.x.size());
  bool walked = true;
  for (int tree = 0; tree < static_cast<int>(forest.roots.size()); ++tree) {
    std::vector<std::int32_t> leaves(patches.x.size() * step + 1, kNobody);
    const WalkingPatches walking{&image, patches.x.data(), patches.y.data(), patches.scale.data(), count};
    walked = walk_wide(forest, tree, walking, step, leaves.data());
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const std::size_t p = i / step;
      std::int32_t expected = kNobody;
      if (walked && i % step == 0 && p < patches.x.size()) {
        expected = find_leaf(forest, tree, image.patch(patches.x[p], patches.y[p], patches.scale[p]));
      }
      EXPECT_EQ(leaves[i], expected) << "tree " << tree << " patch " << p << " of " << count;
      if (leaves[i] != expected) return walked;
    }
  }
  return walked;
}

/// What the processor can do, one instruction set at a time.
class WideWalk : public ::testing::Test {
 protected:
  void TearDown() override { use(0); }

  static void use(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // the next call chooses anew
  }

  static bool gathers(std::int64_t target) { return (target & (HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL)) != 0; }
};

TEST_F(WideWalk, EveryInstructionSetReachesTheLeavesOfFindLeaf) {
  Random random(11);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    use(target);
    for (const int planes : {32, 64, 256}) {
      const FeatureImage image = random_image(planes, random);
      const Forest forest = random_forest(planes, random);
      const Patches patches = random_patches(image, 500, random);
      EXPECT_EQ(walks_like_find_leaf(forest, image, patches, 3), gathers(target));
    }
  }
}

TEST_F(WideWalk, AnyNumberOfPatchesMayWalk) {
  Random random(12);
  const FeatureImage image = random_image(64, random);
  const Forest forest = random_forest(64, random);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    use(target);
    for (int count = 0; count <= 140; ++count) {
      EXPECT_EQ(walks_like_find_leaf(forest, image, random_patches(image, count, random), 1), gathers(target));
    }
  }
}

TEST_F(WideWalk, AForestOfLeavesOnlyIsLeftToOthers) {
  Random random(13);
  const FeatureImage image = random_image(32, random);
  Forest forest;
  forest.roots = {-1, -2};
  EXPECT_FALSE(walks_like_find_leaf(forest, image, random_patches(image, 20, random), 1));
}

}  // namespace
}  // namespace houghstream
