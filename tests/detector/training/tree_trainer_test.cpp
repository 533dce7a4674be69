#include "detector/training/tree_trainer.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "detector/baseline/gall_profile.hpp"
#include "tests/detector/planted_set.hpp"

namespace houghstream::training {
namespace {

TrainingSettings quick() {
  TrainingSettings settings;
  settings.tests_per_node = 600;
  return settings;
}

bool same_tree(const Forest& a, const Forest& b) {
  if (a.nodes.size() != b.nodes.size() || a.votes.size() != b.votes.size() || a.leaves != b.leaves) return false;
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    if (std::memcmp(&a.nodes[i], &b.nodes[i], sizeof(TreeNode)) != 0) return false;
  }
  for (std::size_t i = 0; i < a.votes.size(); ++i) {
    if (std::memcmp(&a.votes[i], &b.votes[i], sizeof(LeafVote)) != 0) return false;
  }
  return true;
}

TEST(TreeTrainer, TheBagHoldsItsShareOfTheImages) {
  TrainingSettings settings;
  settings.in_bag = 0.75;
  int inside = 0;
  int alike = 0;
  int alike_next_tree = 0;
  constexpr int kImages = 4000;
  for (int image = 0; image < kImages; ++image) {
    const bool in = in_bag(settings, 3, image);
    inside += in ? 1 : 0;
    alike += in == in_bag(settings, 3, image) ? 1 : 0;
    alike_next_tree += in == in_bag(settings, 4, image) ? 1 : 0;
  }
  EXPECT_NEAR(inside, 0.75 * kImages, 0.03 * kImages);
  EXPECT_EQ(alike, kImages);
  EXPECT_NEAR(alike_next_tree, (0.75 * 0.75 + 0.25 * 0.25) * kImages, 0.04 * kImages);  // independent
}

TEST(TreeTrainer, ATreeTellsHeldOutImagesApart) {
  const TrainingSet set = toy::planted_set();
  const TrainingSettings settings = quick();
  const Forest tree = grow_tree(set, {}, settings, 0);
  int held_out = 0;
  for (const TrainingSample& sample : set.samples) {
    if (in_bag(settings, 0, sample.image)) continue;
    ++held_out;
    const auto leaf = static_cast<std::size_t>(find_leaf(tree, 0, set.patch(sample)));
    const bool is_object = tree.leaves[leaf] < tree.leaves[leaf + 1];
    ASSERT_EQ(is_object, sample.label != 0);
    if (!is_object) continue;
    const LeafClass& entry = tree.leaf_classes[tree.leaves[leaf]];
    EXPECT_FLOAT_EQ(entry.probability, 1.0F);
    ASSERT_EQ(entry.vote_count, 1);
    const LeafVote& vote = tree.votes[find_leaf_starts(tree)[leaf].vote];
    EXPECT_NEAR((vote.offset() - sample.offset).norm(), 0.0F, LeafVote::kStep_m);
  }
  EXPECT_GT(held_out, 0);
}

TEST(TreeTrainer, NodesAreSplitByOffsetsAsOftenAsAsked) {
  const auto first_plane = [](double offset_fraction) {
    TrainingSettings settings = quick();
    settings.offset_fraction = offset_fraction;
    return static_cast<int>(grow_tree(toy::planted_set(), {}, settings, 0).nodes.at(0).test.plane);
  };
  EXPECT_EQ(first_plane(0.0), toy::kClassPlane);
  EXPECT_EQ(first_plane(1.0), toy::kOffsetPlane);
}

TEST(TreeTrainer, EveryChildIsReachedOnce) {
  const Forest tree = grow_tree(toy::planted_set(), {}, quick(), 1);
  ASSERT_EQ(tree.roots, std::vector<std::int32_t>{0});
  EXPECT_EQ(tree.leaves.size(), tree.nodes.size() + 2);  // a leaf more than nodes, and the end
  std::vector<int> seen_nodes(tree.nodes.size(), 0);
  std::vector<int> seen_leaves(tree.leaves.size() - 1, 0);
  seen_nodes[0] = 1;
  for (const TreeNode& node : tree.nodes) {
    for (const std::int32_t child : {node.left, node.right}) {
      ++(child >= 0 ? seen_nodes.at(static_cast<std::size_t>(child))
                    : seen_leaves.at(static_cast<std::size_t>(-1 - child)));
    }
  }
  EXPECT_EQ(seen_nodes, std::vector<int>(seen_nodes.size(), 1));
  EXPECT_EQ(seen_leaves, std::vector<int>(seen_leaves.size(), 1));
}

TEST(TreeTrainer, SeedAndNumberAloneDecide) {
  const TrainingSet set = toy::planted_set();
  TrainingSettings settings = quick();
  const Forest tree = grow_tree(set, {}, settings, 2);
  EXPECT_TRUE(same_tree(tree, grow_tree(set, {}, settings, 2)));
  EXPECT_FALSE(same_tree(tree, grow_tree(set, {}, settings, 3)));
  settings.threads = 5;
  EXPECT_TRUE(same_tree(tree, grow_tree(set, {}, settings, 2)));
  settings.seed = 99;
  EXPECT_FALSE(same_tree(tree, grow_tree(set, {}, settings, 2)));
}

TEST(TreeTrainer, TheBackgroundWeighsAsMuchAsAllObjects) {
  TrainingSet set = toy::planted_set();
  TrainingSettings settings = quick();
  settings.max_depth = 0;
  settings.in_bag = 1.0;
  for (std::size_t i = 0; i < 300; ++i) set.samples.push_back(set.samples[0]);  // more background
  const Forest leaf = grow_tree(set, {}, settings, 0);
  EXPECT_EQ(leaf.roots, std::vector<std::int32_t>{-1});
  ASSERT_EQ(leaf.leaf_classes.size(), 1U);
  EXPECT_NEAR(leaf.leaf_classes[0].probability, 0.5F, 1e-4F);
}

TEST(TreeTrainer, WhatAPatchIsWorthToAnObjectDoesNotDependOnHowManyOthersWereTaught) {
  const auto share_of_one_among = [](int objects, TrainingSettings settings = quick()) {
    TrainingSet set = toy::planted_set();
    set.classes.resize(static_cast<std::size_t>(objects));
    settings.max_depth = 0;
    settings.in_bag = 1.0;
    for (std::size_t i = 0; i < set.samples.size(); ++i) {
      if (set.samples[i].label != 0) set.samples[i].label = static_cast<std::uint16_t>(1 + i % objects);
    }
    const Forest leaf = grow_tree(set, {}, settings, 0);
    const float all = leaf.leaf_classes[0].probability * static_cast<float>(objects);
    return leaf.leaf_classes[0].probability / (1.0F - all);  // over the background's
  };
  EXPECT_NEAR(share_of_one_among(4), 0.25F, 1e-4F);
  EXPECT_NEAR(share_of_one_among(16), share_of_one_among(4), 1e-4F);
  EXPECT_NEAR(share_of_one_among(16, baseline::make_profile("gall").training), 1.0F / 16.0F, 1e-4F)
      << "but in the original";
}

}  // namespace
}  // namespace houghstream::training
