#include "detector/training/leaf_builder.hpp"

#include <gtest/gtest.h>

namespace houghstream {
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
  leaf.number = add_leaf(set, all, weights, 16.0F, settings, leaf.forest);
  return leaf;
}

TEST(LeafBuilder, NearOffsetsBecomeOneVoteAtTheirMean) {
  const Forest forest = build({sample(1, 0.05F), sample(1, 0.0F), sample(1, 0.004F)}, {1, 1}).forest;
  ASSERT_EQ(forest.votes.size(), 2U);
  EXPECT_FLOAT_EQ(forest.votes[0].offset.x(), 0.002F);
  EXPECT_FLOAT_EQ(forest.votes[0].weight, 2.0F / 3.0F);
  EXPECT_FLOAT_EQ(forest.votes[1].offset.x(), 0.05F);
  EXPECT_FLOAT_EQ(forest.votes[1].weight, 1.0F / 3.0F);
}

TEST(LeafBuilder, ProbabilitiesFollowTheLabelWeights) {
  // background 4 x 0.5, class 0 twice 1, class 1 once 4: 2 + 2 + 4
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
  EXPECT_EQ(leaf.forest.votes[classes[1].first_vote].weight, 1.0F);
  EXPECT_EQ(leaf.number, 0);
  EXPECT_EQ(leaf.forest.leaves, (std::vector<std::uint32_t>{0, 2}));
}

TEST(LeafBuilder, ALeafOfBackgroundKnowsNoClass) {
  const Leaf leaf = build({sample(0, 0), sample(0, 0)}, {1.0F, 1.0F});
  EXPECT_TRUE(leaf.forest.leaf_classes.empty());
  EXPECT_TRUE(leaf.forest.votes.empty());
  EXPECT_EQ(leaf.forest.leaves, (std::vector<std::uint32_t>{0, 0}));
}

TEST(LeafBuilder, TheHeaviestVotesAndViewsAreKept) {
  std::vector<TrainingSample> samples = {sample(1, 0.0F, 9)};
  for (int i = 0; i < 2; ++i) samples.push_back(sample(1, 0.1F, 4));
  for (int i = 0; i < 3; ++i) samples.push_back(sample(1, 0.2F, 7));
  TrainingSettings settings;
  settings.max_leaf_votes = 2;
  settings.max_leaf_views = 2;
  const Forest forest = build(samples, {1, 1}, settings).forest;
  ASSERT_EQ(forest.votes.size(), 2U);
  EXPECT_FLOAT_EQ(forest.votes[0].offset.x(), 0.2F);
  EXPECT_FLOAT_EQ(forest.votes[0].weight, 0.5F);  // of all samples: what was dropped is not made up for
  EXPECT_FLOAT_EQ(forest.votes[1].offset.x(), 0.1F);
  ASSERT_EQ(forest.leaf_views.size(), 2U);
  EXPECT_EQ(forest.leaf_views[0].view, 7U);
  EXPECT_FLOAT_EQ(forest.leaf_views[0].weight, 0.5F);
  EXPECT_EQ(forest.leaf_views[1].view, 4U);
  EXPECT_EQ(forest.leaf_classes[0].vote_count, 2);
  EXPECT_EQ(forest.leaf_classes[0].view_count, 2);
}

TEST(LeafBuilder, TheSecondLeafFollowsTheFirst) {
  TrainingSet set;
  set.samples = {sample(1, 0.0F), sample(1, 0.3F, 5)};
  Forest forest;
  forest.leaves.push_back(0);
  EXPECT_EQ(add_leaf(set, {0}, {1, 1}, 1.0F, {}, forest), 0);
  EXPECT_EQ(add_leaf(set, {1}, {1, 1}, 1.0F, {}, forest), 1);
  const LeafClass& second = forest.leaf_classes[forest.leaves[1]];
  EXPECT_FLOAT_EQ(forest.votes[second.first_vote].offset.x(), 0.3F);
  EXPECT_EQ(forest.leaf_views[second.first_view].view, 5U);
}

}  // namespace
}  // namespace houghstream
