#include "detector/voting/hypotheses.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/detector/small_camera.hpp"

namespace houghstream {
namespace {

/// Returns a forest of one leaf that takes every patch for the centre of the only class.
Forest centre_forest() {
  Forest forest;
  forest.classes.emplace_back();
  forest.views.resize(2);
  forest.roots = {-1};
  forest.leaves = {0, 1};
  LeafClass entry;
  entry.probability = 1.0F;
  entry.vote_count = 1;
  entry.view_count = 2;
  forest.leaf_classes.push_back(entry);
  forest.votes.emplace_back(Eigen::Vector3f::Zero(), 1.0F);
  forest.leaf_views = {{0, Share(0.25F)}, {1, Share(0.75F)}};
  return forest;
}

/// Patches in a small cross around a point.
void add_cluster(const Eigen::Vector3f& centre, float area, PatchGrid& patches) {
  constexpr float kArm = 0.004F;
  for (const Eigen::Vector3f& d : {Eigen::Vector3f(kArm, 0, 0), Eigen::Vector3f(-kArm, 0, 0),
                                   Eigen::Vector3f(0, kArm, 0), Eigen::Vector3f(0, -kArm, 0)}) {
    patches.x.push_back(0);
    patches.point_camera.emplace_back(centre + d);
    patches.area.push_back(area);
  }
}

PatchPosteriors all_voting(const ForestIndex& index, const PatchGrid& patches) {
  const std::vector<std::int32_t> leaves(patches.size(), 0);
  PatchPosteriors posteriors(index, 1, 0.0F);
  std::vector<std::uint32_t> all(patches.size());
  std::iota(all.begin(), all.end(), 0U);
  posteriors.note({0, all.size(), all.data(), leaves.data()});
  return posteriors;
}

std::vector<Hypothesis> find(const PatchGrid& patches, float min_mass) {
  Forest forest = centre_forest();
  forest.classes[0].nominal_vote_mass = 1.0F;
  const ForestIndex index(forest);
  const PatchPosteriors posteriors = all_voting(index, patches);
  VotingSettings settings;
  settings.min_mass_fraction = min_mass;
  const VotingInput input{forest, patches, posteriors, toy::kSmallCamera, settings};
  VotingWorkspace::Worker workspace;
  cast_votes(input, 0, workspace.casting, workspace.space);
  return class_hypotheses(input, 0, workspace);
}

TEST(Hypotheses, ClassesOfOtherForestsShareTheCandidates) {
  PatchGrid patches;
  for (int i = 0; i < 9; ++i) add_cluster({-0.4F + 0.1F * static_cast<float>(i), 0.0F, 1.0F}, 0.0001F, patches);
  Forest forest = centre_forest();
  forest.classes[0].nominal_vote_mass = 1.0F;
  const ForestIndex index(forest);
  const PatchPosteriors posteriors = all_voting(index, patches);
  VotingSettings settings;
  settings.min_mass_fraction = 0.0F;
  const auto count = [&](std::size_t searched_classes) {
    VotingInput input{forest, patches, posteriors, toy::kSmallCamera, settings};
    input.searched_classes = searched_classes;
    VotingWorkspace::Worker workspace;
    cast_votes(input, 0, workspace.casting, workspace.space);
    return class_hypotheses(input, 0, workspace).size();
  };
  EXPECT_EQ(count(0), 9U);
  EXPECT_EQ(count(40), 6U) << "as many as a forest of 40 classes offers";
}

TEST(Hypotheses, TwoClustersGiveTwoMaximaAtTheirMeans) {
  const Eigen::Vector3f left(-0.15F, 0.05F, 1.0F);
  const Eigen::Vector3f right(0.15F, 0.05F, 1.02F);
  PatchGrid patches;
  add_cluster(left, 0.0001F, patches);
  add_cluster(right, 0.0002F, patches);  // more of it is seen
  const std::vector<Hypothesis> found = find(patches, 0.0F);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_LT((found[0].centre_camera - right).norm(), 0.001F) << found[0].centre_camera.transpose();
  EXPECT_LT((found[1].centre_camera - left).norm(), 0.001F) << found[1].centre_camera.transpose();
  EXPECT_EQ(found[0].vote_count, 4);
  const float kernel = vote_kernel(0.004F * 0.004F, VotingSettings{}.vote_sigma);
  EXPECT_NEAR(found[0].vote_mass, 4 * 0.0002F * kernel, 1e-6F);
  EXPECT_NEAR(found[0].weight, 4 * kernel, 0.01F);
  ASSERT_EQ(found[0].patches.size(), 4U);
  EXPECT_EQ(found[0].patches[0].first, 4U);
  ASSERT_EQ(found[0].views.size(), 2U);
  EXPECT_EQ(found[0].views[0].first, 1U);  // the heavier
  EXPECT_NEAR(found[0].views[0].second, 0.75F * found[0].weight, 1e-4F);
}

TEST(Hypotheses, CentresBehindEachOtherAreNotMixed) {
  PatchGrid patches;
  add_cluster({0, 0, 0.8F}, 0.0001F, patches);
  add_cluster({0, 0, 0.8F}, 0.0001F, patches);
  add_cluster({0, 0, 1.1F}, 0.0001F, patches);
  const std::vector<Hypothesis> found = find(patches, 0.0F);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found[0].centre_camera.z(), 0.8F, 0.001F);
  EXPECT_EQ(found[0].vote_count, 8);
}

TEST(Hypotheses, WhatIsFarIsNotPassedOverForWhatHasMorePatches) {
  const Eigen::Vector3f near(-0.1F, 0.0F, 0.8F);
  const Eigen::Vector3f far(0.2F, 0.0F, 1.6F);
  PatchGrid patches;
  for (int i = 0; i < 2; ++i) add_cluster(near, 0.0001F, patches);
  add_cluster(far, 0.0004F, patches);
  const Forest forest = centre_forest();
  const ForestIndex index(forest);
  const PatchPosteriors posteriors = all_voting(index, patches);
  VotingSettings settings;
  settings.min_mass_fraction = 0.0F;
  settings.candidates_per_class = 1;
  const VotingInput input{forest, patches, posteriors, toy::kSmallCamera, settings};
  VotingWorkspace workspace;
  const std::vector<Hypothesis> found = find_hypotheses(input, 1, workspace);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT((found[0].centre_camera - far).norm(), 0.001F) << found[0].centre_camera.transpose();
}

TEST(Hypotheses, WeakOnesAndEmptySpacesGiveNothing) {
  PatchGrid patches;
  EXPECT_TRUE(find(patches, 0.0F).empty());
  add_cluster({0, 0, 1}, 0.0001F, patches);
  EXPECT_EQ(find(patches, 0.0002F).size(), 1U);
  EXPECT_TRUE(find(patches, 0.0005F).empty());
}

}  // namespace
}  // namespace houghstream
