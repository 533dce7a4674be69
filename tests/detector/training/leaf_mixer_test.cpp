#include "detector/training/leaf_mixer.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

/// A leaf that holds a fifth of its tree: 0.3 class 0, 0.1 class 1, else background.
Forest old_forest() {
  Forest forest;
  forest.leaves = {0, 2};
  forest.leaf_weights = {0.2F};
  forest.leaf_classes.resize(2);
  forest.leaf_classes[0].probability = 0.3F;
  forest.leaf_classes[0].vote_count = 1;
  forest.leaf_classes[1].probability = 0.1F;
  forest.leaf_classes[1].class_index = 1;
  forest.leaf_classes[1].first_vote = 1;
  forest.leaf_classes[1].vote_count = 1;
  forest.leaf_classes[1].view_count = 1;
  forest.votes = {{Eigen::Vector3f(1, 0, 0), 1.0F}, {Eigen::Vector3f(2, 0, 0), 1.0F}};
  forest.leaf_views = {{7, 1.0F}};
  return forest;
}

/// The last leaf made of new samples alone: 0.8 class 2, a tenth of all new samples.
Forest new_forest() {
  Forest forest;
  forest.leaves = {0, 1};
  forest.leaf_weights = {0.1F};
  forest.leaf_classes.resize(1);
  forest.leaf_classes[0].class_index = 2;
  forest.leaf_classes[0].probability = 0.8F;
  return forest;
}

TEST(LeafMixer, EveryObjectWeighsTheSameAndTheBackgroundStays) {
  const Forest old = old_forest();
  Forest forest = new_forest();
  mix_in({&old, 0, 2.0F / 3.0F}, 0.5F, forest);
  // half of the old leaf: 0.06 background; objects 0.03 and 0.01, two thirds of it; new: a third of 0.08
  const float total = 0.06F + 0.02F + 0.0066667F + 0.0266667F;
  ASSERT_EQ(forest.leaf_classes.size(), 3U);
  EXPECT_EQ(forest.leaves.back(), 3U);
  EXPECT_NEAR(forest.leaf_weights.back(), total, 1e-5F);
  EXPECT_NEAR(forest.leaf_classes[0].probability, 0.0266667F / total, 1e-4F);
  EXPECT_NEAR(forest.leaf_classes[1].probability, 0.02F / total, 1e-4F);
  EXPECT_NEAR(forest.leaf_classes[2].probability, 0.0066667F / total, 1e-4F);
}

TEST(LeafMixer, VotesAndViewsComeAlong) {
  const Forest old = old_forest();
  Forest forest = new_forest();
  mix_in({&old, 0, 2.0F / 3.0F}, 1.0F, forest);
  const LeafClass& entry = forest.leaf_classes[2];
  EXPECT_EQ(entry.class_index, 1);
  ASSERT_LT(entry.first_vote, forest.votes.size());
  EXPECT_EQ(forest.votes[entry.first_vote].offset.x(), 2.0F);
  ASSERT_LT(entry.first_view, forest.leaf_views.size());
  EXPECT_EQ(forest.leaf_views[entry.first_view].view, 7U);
}

TEST(LeafMixer, ALeafThatNothingNewReachesKeepsWhatItKnows) {
  const Forest old = old_forest();
  Forest forest;
  forest.leaves = {0};
  EXPECT_EQ(copy_leaf({&old, 0, 0.5F}, forest), 0);
  ASSERT_EQ(forest.leaf_classes.size(), 2U);
  const float total = 0.12F + 0.03F + 0.01F;
  EXPECT_NEAR(forest.leaf_weights.back(), total, 1e-5F);
  EXPECT_NEAR(forest.leaf_classes[0].probability, 0.03F / total, 1e-4F);
  EXPECT_NEAR(forest.leaf_classes[1].probability, 0.01F / total, 1e-4F);
}

}  // namespace
}  // namespace houghstream
