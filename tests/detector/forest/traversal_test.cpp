#include "detector/forest/traversal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "detector/baseline/reference_stages.hpp"
#include "detector/features/features.hpp"
#include "detector/training/forest_trainer.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

/// All leaves of a grid, patch by patch, as find_leaves and, with a number of threads below 0, reference_leaves
/// tell them. -1 for patches that were given up.
std::vector<std::int32_t> leaves_of(const ForestIndex& index, const std::vector<FeatureImage>& features,
                                    const PatchGrid& patches, int threads, const EarlyRejection& early_rejection = {}) {
  const std::size_t trees = index.forest().roots.size();
  std::vector<PatchRun> runs;
  list_runs(patches, runs);
  std::vector<std::int32_t> leaves(patches.size() * trees, -1);
  const auto visit = [&](const RunLeaves& seen) {
    for (std::size_t i = 0; i < seen.count; ++i) {
      EXPECT_GE(seen.patches[i], runs[seen.run].first);
      EXPECT_LT(seen.patches[i], runs[seen.run].first + runs[seen.run].count);
      for (std::size_t tree = 0; tree < trees; ++tree) {
        leaves[seen.patches[i] * trees + tree] = seen.leaves[tree * seen.count + i];
      }
    }
  };
  LeafInput input{index, features, patches, runs};
  input.early_rejection = early_rejection;
  LeafWorkspace workspace;
  if (threads > 0) {
    find_leaves(input, threads, workspace, visit);
  } else {
    baseline::reference_leaves(input, -threads, visit);
  }
  return leaves;
}

void expect_leaves_of_find_leaf(const ForestIndex& index, const std::vector<FeatureImage>& features,
                                const PatchGrid& patches) {
  const Forest& forest = index.forest();
  for (const int threads : {-2, -1, 1, 2}) {
    const std::vector<std::int32_t> leaves = leaves_of(index, features, patches, threads);
    for (std::size_t p = 0; p < patches.size(); ++p) {
      for (std::size_t tree = 0; tree < forest.roots.size(); ++tree) {
        const FeatureImage& image = features[patches.level[p]];
        const std::int32_t leaf =
            find_leaf(forest, static_cast<int>(tree), image.patch(patches.x[p], patches.y[p], patches.scale[p]));
        ASSERT_EQ(leaves[p * forest.roots.size() + tree], leaf) << "patch " << p << " tree " << tree;
      }
    }
  }
}

class Traversal : public ::testing::Test {
 protected:
  Traversal() { toy::put_tile(1, 150, 100, 0.8, room); }

  /// Compares who goes on after `trees` trees, and where to, with the forest's leaves; some but not all do where the
  /// share is neither 0 nor large.
  void expect_given_up_after(int trees, float fraction, const std::vector<FeatureImage>& features,
                             const PatchGrid& patches) const {
    const std::size_t all = forest.roots.size();
    std::vector<std::int32_t> expected = leaves_of(index, features, patches, 1);
    std::size_t given_up = 0;
    for (std::size_t p = 0; p < patches.size(); ++p) {
      float sum = 0.0F;
      for (int tree = 0; tree < trees; ++tree) sum += index.leaf_summaries()[expected[p * all + tree]].max_posterior;
      if (sum >= fraction * static_cast<float>(trees)) continue;
      ++given_up;
      std::fill_n(expected.begin() + static_cast<std::ptrdiff_t>(p * all), all, -1);
    }
    EXPECT_EQ(given_up > 0, fraction > 0.0F);
    EXPECT_LT(given_up, patches.size());
    for (const int threads : {-3, -1, 1, 2, 3}) {
      EXPECT_EQ(leaves_of(index, features, patches, threads, {trees, fraction}), expected) << threads << " threads";
    }
  }

  /// Processes all levels, with a patch every `stride` pixels.
  void look_at_background(int stride, std::vector<FeatureImage>& features, PatchGrid& patches) const {
    for (const FeatureLevel& level : feature_levels(forest.features)) {
      const WorkingFrame frame = make_working_frame(room, level, forest.features);
      add_patches(frame, level, static_cast<std::uint8_t>(features.size()), {forest.patch, {stride, 0.0F}}, patches);
      features.push_back(compute_features(frame, forest.features, 2));
    }
  }

  const Forest forest = training::train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  const ForestIndex index{forest};
  RgbdFrame room = toy::background(5);
};

TEST_F(Traversal, ManyPatchesAtOnceReachTheLeavesOfOneAtATime) {
  std::vector<FeatureImage> features;
  PatchGrid patches;
  look_at_background(2, features, patches);
  ASSERT_GT(patches.size(), 4000U);
  expect_leaves_of_find_leaf(index, features, patches);
  for (const float fraction : {0.0F, 0.02F, 0.3F}) expect_given_up_after(2, fraction, features, patches);
}

TEST_F(Traversal, SoDoPatchesAtEveryPixelAndThoseWithGaps) {
  const FeatureLevel level = feature_levels(forest.features)[0];
  const WorkingFrame frame = make_working_frame(room, level, forest.features);
  std::vector<FeatureImage> features;
  features.push_back(compute_features(frame, forest.features, 2));
  PatchSettings pixels = forest.patch;
  pixels.unit = 1.0F;
  for (const int stride : {1, 3}) {
    PatchGrid patches;
    add_patches_everywhere(frame, level, pixels, stride, patches);
    expect_leaves_of_find_leaf(index, features, patches);
    expect_given_up_after(1, 0.02F, features, patches);
  }
}

TEST_F(Traversal, SoDoPatchesAtEveryPixelWithDepth) {
  room.depth(cv::Rect(100, 40, 90, 90)).setTo(0.45F);  // nearer, and some pixels know no depth
  std::vector<FeatureImage> features;
  PatchGrid patches;
  look_at_background(1, features, patches);
  expect_leaves_of_find_leaf(index, features, patches);
  for (const float fraction : {0.0F, 0.02F, 0.3F}) expect_given_up_after(2, fraction, features, patches);
}

TEST_F(Traversal, NobodyIsGivenUpAfterTheLastTree) {
  const int trees = static_cast<int>(forest.roots.size());
  EXPECT_TRUE((EarlyRejection{trees - 1, 0.1F}.is_enabled(forest)));
  EXPECT_FALSE((EarlyRejection{trees, 0.1F}.is_enabled(forest)));
  EXPECT_FALSE((EarlyRejection{0, 0.1F}.is_enabled(forest)));
}

TEST(FeatureLevels, MeetWithoutAGap) {
  const auto levels = feature_levels(FeatureSettings{});
  EXPECT_TRUE(levels[0].contains(1.2F));
  EXPECT_FALSE(levels[1].contains(1.2F));
  EXPECT_TRUE(levels[1].contains(1.21F));
  EXPECT_FALSE(levels[1].contains(std::numeric_limits<float>::quiet_NaN()));
}

}  // namespace
}  // namespace houghstream
