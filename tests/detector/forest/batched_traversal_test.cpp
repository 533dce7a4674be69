#include "detector/forest/batched_traversal.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "pipeline/base/random.hpp"
#include "tests/detector/forest/random_forest.hpp"

namespace houghstream {
namespace {

const PatchSettings kPatch;
constexpr std::int32_t kNobody = -77;

/// The patches are the image's corners with the widest patches, then random ones.
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

/// Compares the walk of all patches down some trees with find_leaf, and says whether there was one.
bool walks_like_find_leaf(const Forest& forest, TreeRange trees, const FeatureImage& image, const Patches& patches) {
  const std::size_t count = patches.x.size();
  std::vector<std::int32_t> leaves((trees.last - trees.first) * count + 1, kNobody);
  PatchBatch walking;
  walking.image = &image;
  walking.x = patches.x.data();
  walking.y = patches.y.data();
  walking.scale = patches.scale.data();
  walking.count = static_cast<int>(count);
  const bool walked = traverse_batched(pack_trees(forest), trees, walking, leaves.data());
  std::vector<std::int32_t> expected(leaves.size(), kNobody);
  for (std::size_t i = 0; walked && i + 1 < expected.size(); ++i) {
    const std::size_t p = i % count;
    const auto tree = static_cast<int>(trees.first + i / count);
    expected[i] = find_leaf(forest, tree, image.patch(patches.x[p], patches.y[p], patches.scale[p]));
  }
  EXPECT_EQ(leaves, expected) << "trees " << trees.first << " to " << trees.last << ", " << count << " patches";
  return walked;
}

/// Traverses all trees at once, and then some.
bool walks_like_find_leaf(const Forest& forest, const FeatureImage& image, const Patches& patches) {
  const std::size_t trees = forest.roots.size();
  const bool some = walks_like_find_leaf(forest, {trees / 2, trees}, image, patches);
  return walks_like_find_leaf(forest, {0, trees}, image, patches) && some;
}

/// Runs the test with each instruction set of the processor.
class WideWalk : public ::testing::Test {
 protected:
  void TearDown() override { use(0); }

  static void use(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // the next call selects the target again
  }
};

TEST_F(WideWalk, EveryInstructionSetReachesTheLeavesOfFindLeaf) {
  Random random(11);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    use(target);
    for (const int planes : {32, 64, 256}) {
      const FeatureImage image = chance::random_image(21, 13, planes, random);
      const Forest forest = chance::random_forest(planes, random);
      const Patches patches = random_patches(image, 500, random);
      EXPECT_TRUE(walks_like_find_leaf(forest, image, patches));
    }
  }
}

TEST_F(WideWalk, AnyNumberOfPatchesMayWalk) {
  Random random(12);
  const FeatureImage image = chance::random_image(21, 13, 64, random);
  const Forest forest = chance::random_forest(64, random);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    use(target);
    for (int count = 0; count <= 300; ++count) {
      EXPECT_TRUE(walks_like_find_leaf(forest, image, random_patches(image, count, random)));
    }
  }
}

TEST_F(WideWalk, TreesMayBeLeaves) {
  Random random(13);
  const FeatureImage image = chance::random_image(21, 13, 32, random);
  Forest forest;
  forest.roots = {-1, -2};
  EXPECT_TRUE(walks_like_find_leaf(forest, image, random_patches(image, 20, random)));
}

TEST_F(WideWalk, AForestThatIsNotPackedIsLeftToOthers) {
  Random random(14);
  const FeatureImage image = chance::random_image(21, 13, 32, random);
  Forest forest = chance::random_forest(32, random);
  forest.nodes[0].test.dx1 = 100;  // farther than a packed node can look
  EXPECT_FALSE(walks_like_find_leaf(forest, image, random_patches(image, 20, random)));
}

}  // namespace
}  // namespace houghstream
