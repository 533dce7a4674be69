#include "detector/training/leaves.hpp"

#include <gtest/gtest.h>

namespace houghstream::training {
namespace {

TrainingSample sample(int label, float x, std::uint32_t view = 0) {
  TrainingSample out;
  out.label = static_cast<std::uint16_t>(label);
  out.offset = Eigen::Vector3f(x, 0.0F, 0.0F);
  out.view = view;
  return out;
}

struct Leaf {
  Forest forest;
  std::int32_t number = 0;
};

Leaf build(const std::vector<TrainingSample>& samples, const std::vector<float>& weights,
           const TrainingSettings& settings = {}) {
  TrainingSet set;
  set.samples = samples;
  std::vector<std::uint32_t> all(samples.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  Leaf leaf;
  leaf.forest.leaves.push_back(0);
  leaf.number = add_leaf({set, settings, weights, 16.0F}, all, leaf.forest);
  return leaf;
}

TEST(AddLeaf, NearOffsetsBecomeOneVoteAtTheirMean) {
  const Forest forest = build({sample(1, 0.05F), sample(1, 0.0F), sample(1, 0.004F)}, {1, 1}).forest;
  ASSERT_EQ(forest.votes.size(), 2U);
  EXPECT_NEAR(forest.votes[0].offset().x(), 0.002F, LeafVote::kStep_m);
  EXPECT_NEAR(forest.votes[0].weight.value(), 2.0F / 3.0F, Share::kStep);
  EXPECT_NEAR(forest.votes[1].offset().x(), 0.05F, LeafVote::kStep_m);
  EXPECT_NEAR(forest.votes[1].weight.value(), 1.0F / 3.0F, Share::kStep);
}

TEST(AddLeaf, ProbabilitiesFollowTheLabelWeights) {
  // The weights are background 4 x 0.5, class 0 twice 1, class 1 once 4: 2 + 2 + 4.
  const std::vector<TrainingSample> samples = {sample(0, 0), sample(0, 0), sample(0, 0), sample(0, 0),
                                               sample(2, 0), sample(1, 0), sample(1, 0)};
  const Leaf leaf = build(samples, {0.5F, 1.0F, 4.0F});
  const std::vector<LeafClass>& classes = leaf.forest.leaf_classes;
  ASSERT_EQ(classes.size(), 2U);
  EXPECT_EQ(classes[0].class_index, 0);
  EXPECT_FLOAT_EQ(leaf.forest.leaf_weights.back(), 0.5F) << "8 of 16";
  EXPECT_FLOAT_EQ(classes[0].probability, 0.25F);
  EXPECT_EQ(classes[1].class_index, 1);
  EXPECT_FLOAT_EQ(classes[1].probability, 0.5F);
  EXPECT_EQ(leaf.forest.votes[classes[0].vote_count].weight.value(), 1.0F);
  EXPECT_EQ(leaf.number, 0);
  EXPECT_EQ(leaf.forest.leaves, (std::vector<std::uint32_t>{0, 2}));
}

TEST(AddLeaf, ALeafOfBackgroundKnowsNoClass) {
  const Leaf leaf = build({sample(0, 0), sample(0, 0)}, {1.0F, 1.0F});
  EXPECT_TRUE(leaf.forest.leaf_classes.empty());
  EXPECT_TRUE(leaf.forest.votes.empty());
  EXPECT_EQ(leaf.forest.leaves, (std::vector<std::uint32_t>{0, 0}));
}

TEST(AddLeaf, TheHeaviestVotesAndViewsAreKept) {
  std::vector<TrainingSample> samples = {sample(1, 0.0F, 9)};
  for (int i = 0; i < 2; ++i) samples.push_back(sample(1, 0.1F, 4));
  for (int i = 0; i < 3; ++i) samples.push_back(sample(1, 0.2F, 7));
  TrainingSettings settings;
  settings.max_leaf_votes = 2;
  settings.max_leaf_views = 2;
  const Forest forest = build(samples, {1, 1}, settings).forest;
  ASSERT_EQ(forest.votes.size(), 2U);
  EXPECT_NEAR(forest.votes[0].offset().x(), 0.2F, LeafVote::kStep_m);
  EXPECT_NEAR(forest.votes[0].weight.value(), 0.5F,
              Share::kStep);  // fraction of all samples, without replacement of the dropped ones
  EXPECT_NEAR(forest.votes[1].offset().x(), 0.1F, LeafVote::kStep_m);
  ASSERT_EQ(forest.leaf_views.size(), 2U);
  EXPECT_EQ(forest.leaf_views[0].view, 7U);
  EXPECT_NEAR(forest.leaf_views[0].weight.value(), 0.5F, Share::kStep);
  EXPECT_EQ(forest.leaf_views[1].view, 4U);
  EXPECT_EQ(forest.leaf_classes[0].vote_count, 2);
  EXPECT_EQ(forest.leaf_classes[0].view_count, 2);
}

TEST(AddLeaf, TheSecondLeafFollowsTheFirst) {
  TrainingSet set;
  set.samples = {sample(1, 0.0F), sample(1, 0.3F, 5)};
  Forest forest;
  forest.leaves.push_back(0);
  const std::vector<float> weights = {1.0F, 1.0F};
  const LeafSource source{set, {}, weights, 1.0F};
  EXPECT_EQ(add_leaf(source, {0}, forest), 0);
  EXPECT_EQ(add_leaf(source, {1}, forest), 1);
  const LeafStart second = find_leaf_starts(forest).at(1);
  EXPECT_NEAR(forest.votes[second.vote].offset().x(), 0.3F, LeafVote::kStep_m);
  EXPECT_EQ(forest.leaf_views[second.view].view, 5U);
}

/// Returns a leaf that holds a fifth of its tree: 0.3 class 0, 0.1 class 1, else background.
Forest old_forest() {
  Forest forest;
  forest.leaves = {0, 2};
  forest.leaf_weights = {0.2F};
  forest.leaf_classes.resize(2);
  forest.leaf_classes[0].probability = 0.3F;
  forest.leaf_classes[0].vote_count = 1;
  forest.leaf_classes[1].probability = 0.1F;
  forest.leaf_classes[1].class_index = 1;
  forest.leaf_classes[1].vote_count = 1;
  forest.leaf_classes[1].view_count = 1;
  forest.votes = {{Eigen::Vector3f(0.5F, 0, 0), 1.0F}, {Eigen::Vector3f(1, 0, 0), 1.0F}};
  forest.leaf_views = {{7, Share(1.0F)}};
  return forest;
}

/// Returns the last leaf made of new samples alone: 0.8 class 2, a tenth of all new samples.
Forest new_forest() {
  Forest forest;
  forest.leaves = {0, 1};
  forest.leaf_weights = {0.1F};
  forest.leaf_classes.resize(1);
  forest.leaf_classes[0].class_index = 2;
  forest.leaf_classes[0].probability = 0.8F;
  return forest;
}

TEST(MixIn, EveryObjectWeighsTheSameAndTheBackgroundStays) {
  const Forest old = old_forest();
  Forest forest = new_forest();
  merge_leaf({&old, 0, {}, compute_mixture(2, 1, 4)}, 0.5F, forest);
  // The old leaf counts half: 0.06 background; objects 0.03 and 0.01, two thirds of it; the new one counts a third of
  // 0.08.
  const float total = 0.06F + 0.02F + 0.0066667F + 0.0266667F;
  ASSERT_EQ(forest.leaf_classes.size(), 3U);
  EXPECT_EQ(forest.leaves.back(), 3U);
  EXPECT_NEAR(forest.leaf_weights.back(), total, 1e-5F);
  EXPECT_NEAR(forest.leaf_classes[0].probability, 0.0266667F / total, 1e-4F);
  EXPECT_NEAR(forest.leaf_classes[1].probability, 0.02F / total, 1e-4F);
  EXPECT_NEAR(forest.leaf_classes[2].probability, 0.0066667F / total, 1e-4F);
}

TEST(MixIn, AmongManyANewObjectWeighsAsMuchAsAKnownOne) {
  for (const float known : {1.0F, 4.0F, 10.0F, 20.0F}) {
    const LeafMixture mixture = compute_mixture(known, 1.0F, 4.0F);
    const float one_known = mixture.known / (known + std::min(known, 4.0F));  // weight of a forest of `known` objects
    const float one_new = mixture.added / 2.0F;                               // weight of one object and a background
    EXPECT_NEAR(one_known, one_new, 1e-6F) << known;
    const float background = mixture.background * std::min(known, 4.0F) / (known + std::min(known, 4.0F));
    EXPECT_NEAR(known * one_known + one_new + background, 1.0F, 1e-6F) << known;
  }
}

TEST(MixIn, VotesAndViewsComeAlong) {
  const Forest old = old_forest();
  Forest forest = new_forest();
  merge_leaf({&old, 0, {}, compute_mixture(2, 1, 4)}, 1.0F, forest);
  EXPECT_EQ(forest.leaf_classes[2].class_index, 1);
  ASSERT_EQ(forest.votes.size(), 2U);
  EXPECT_EQ(forest.votes[1].offset().x(), 1.0F);
  ASSERT_EQ(forest.leaf_views.size(), 1U);
  EXPECT_EQ(forest.leaf_views[0].view, 7U);
}

TEST(MixIn, ALeafThatNothingNewReachesKeepsWhatItKnows) {
  const Forest old = old_forest();
  Forest forest;
  forest.leaves = {0};
  EXPECT_EQ(copy_leaf({&old, 0, {}, compute_mixture(1, 1, 4)}, forest), 0);
  ASSERT_EQ(forest.leaf_classes.size(), 2U);
  const float total = 0.12F + 0.03F + 0.01F;
  EXPECT_NEAR(forest.leaf_weights.back(), total, 1e-5F);
  EXPECT_NEAR(forest.leaf_classes[0].probability, 0.03F / total, 1e-4F);
  EXPECT_NEAR(forest.leaf_classes[1].probability, 0.01F / total, 1e-4F);
}

}  // namespace
}  // namespace houghstream::training
