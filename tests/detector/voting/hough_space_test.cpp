#include "detector/voting/hough_space.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace houghstream {
namespace {

const Camera kHundredWide{100, 80, 100.0, 100.0, 49.5, 39.5};

/// Returns one tree that is one leaf, certain by `probability` of the only class, with one vote.
Forest one_leaf(const Eigen::Vector3f& offset, float probability) {
  Forest forest;
  forest.classes.emplace_back();
  forest.roots = {-1};
  forest.leaves = {0, 1};
  LeafClass entry;
  entry.probability = probability;
  entry.vote_count = 1;
  forest.leaf_classes.push_back(entry);
  forest.votes.emplace_back(offset, 1.0F);
  return forest;
}

HoughSpace vote(const Forest& forest, const std::vector<Eigen::Vector3f>& points, float min_fraction = 0.1F) {
  PatchGrid patches;
  patches.point_camera = points;
  patches.x.resize(points.size());
  const std::vector<std::int32_t> leaves(points.size() * forest.roots.size(), 0);
  const ForestIndex index(forest);
  PatchPosteriors posteriors(index, 1, min_fraction);
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0U);
  posteriors.note({0, all.size(), all.data(), leaves.data()});
  HoughSpace space;
  CastWorkspace workspace;
  cast_votes({forest, patches, posteriors, kHundredWide, {}}, 0, workspace, space);
  return space;
}

std::size_t cell_of(const HoughSpace& space, std::uint32_t vote) {
  std::size_t cell = 0;
  while (space.first_vote[cell + 1] <= vote) ++cell;
  return cell;
}

TEST(HoughSpace, AVoteLandsWhereItsCentreIsSeen) {
  const HoughSpace space = vote(one_leaf({0.105F, 0.055F, 0.0F}, 0.8F), {{0.0F, 0.0F, 1.0F}});
  ASSERT_EQ(space.voter_of_vote.size(), 1U);
  EXPECT_LT((space.votes[0].centre_camera - Eigen::Vector3f(0.105F, 0.055F, 1.0F)).norm(), LeafVote::kStep_m);
  EXPECT_FLOAT_EQ(space.votes[0].weight, 0.8F);
  EXPECT_EQ(space.width, 50);
  EXPECT_EQ(space.height, 40);
  EXPECT_EQ(cell_of(space, 0), 22U * 50U + 30U);  // pixel (60, 45): cells of 2 pixels
  EXPECT_EQ(std::max_element(space.image.begin(), space.image.end()) - space.image.begin(), 22 * 50 + 30);
}

TEST(HoughSpace, OffsetsTurnWithTheViewingRay) {
  const Eigen::Vector3f point(0.3F, -0.2F, 1.0F);
  const HoughSpace space = vote(one_leaf({0.0F, 0.0F, 0.05F}, 1.0F), {point});
  ASSERT_EQ(space.voter_of_vote.size(), 1U);  // behind the point on its own ray
  EXPECT_LT((space.votes[0].centre_camera - point * (1.0F + 0.05F / point.norm())).norm(), LeafVote::kStep_m);
}

TEST(HoughSpace, APatchOfALowPosteriorCastsNone) {
  EXPECT_TRUE(vote(one_leaf({0, 0, 0}, 0.49F), {{0, 0, 1}}, 0.5F).voter_of_vote.empty());
  EXPECT_EQ(vote(one_leaf({0, 0, 0}, 0.51F), {{0, 0, 1}}, 0.5F).voter_of_vote.size(), 1U);
}

TEST(HoughSpace, VotesOutsideTheImageOrBehindTheCameraAreDropped) {
  const Forest sideways = one_leaf({0.2F, 0.0F, 0.0F}, 1.0F);
  EXPECT_EQ(vote(sideways, {{0.25F, 0, 1}}).voter_of_vote.size(), 1U);
  EXPECT_TRUE(vote(sideways, {{0.45F, 0, 1}}).voter_of_vote.empty());
  EXPECT_TRUE(vote(one_leaf({-0.2F, 0, 0}, 1.0F), {{-0.45F, 0, 1}}).voter_of_vote.empty());
  EXPECT_TRUE(vote(one_leaf({0, 0, -2.0F}, 1.0F), {{0, 0, 1}}).voter_of_vote.empty());
}

TEST(HoughSpace, VotesAreSortedByCellAndKeepTheOrderOfPatches) {
  const HoughSpace space = vote(one_leaf({0, 0, 0}, 1.0F), {{0.3F, 0, 1}, {-0.3F, 0, 1}, {0.3F, 0, 1}});
  ASSERT_EQ(space.voter_of_vote.size(), 3U);
  EXPECT_EQ(space.voters[space.voter_of_vote[0]].patch, 1U);
  EXPECT_EQ(space.voters[space.voter_of_vote[1]].patch, 0U);
  EXPECT_EQ(space.voters[space.voter_of_vote[2]].patch, 2U);
  EXPECT_LT(cell_of(space, 0), cell_of(space, 1));
  EXPECT_EQ(cell_of(space, 1), cell_of(space, 2));
  EXPECT_EQ(space.first_vote.size(), 50U * 40U + 1U);
  EXPECT_EQ(space.first_vote.back(), 3U);
}

TEST(HoughSpace, AVoteIsSharedAmongTheTrees) {
  Forest forest = one_leaf({0, 0, 0}, 0.9F);
  forest.roots = {-1, -1, -1};
  const HoughSpace space = vote(forest, {{0, 0, 1}});
  ASSERT_EQ(space.voter_of_vote.size(), 3U);
  EXPECT_FLOAT_EQ(space.votes[1].weight, 0.3F);
}

TEST(HoughSpace, ASpaceIsUsedAgain) {
  HoughSpace space = vote(one_leaf({0, 0, 0}, 0.9F), {{0.3F, 0, 1}, {0, 0, 1}});
  const Forest forest = one_leaf({0, 0, 0}, 0.9F);
  PatchGrid patches;
  patches.point_camera = {{0.1F, 0, 1}};
  patches.x.resize(1);
  const std::uint32_t patch = 0;
  const std::int32_t leaf = 0;
  const ForestIndex index(forest);
  PatchPosteriors posteriors(index, 1, 0.0F);
  posteriors.note({0, 1, &patch, &leaf});
  CastWorkspace workspace;
  cast_votes({forest, patches, posteriors, kHundredWide, {}}, 0, workspace, space);
  const HoughSpace fresh = vote(forest, patches.point_camera);
  EXPECT_EQ(space.voter_of_vote.size(), 1U);
  EXPECT_EQ(space.voters.size(), 1U);
  EXPECT_EQ(space.first_vote, fresh.first_vote);
  EXPECT_EQ(space.image, fresh.image);
}

TEST(HoughSpace, SmoothingKeepsTheWeight) {
  const HoughSpace space = vote(one_leaf({0, 0, 0}, 0.7F), {{0, 0, 1}});
  float sum = 0.0F;
  for (const float value : space.image) sum += value;
  EXPECT_NEAR(sum, 0.7F, 1e-4F);
  EXPECT_LT(*std::max_element(space.image.begin(), space.image.end()), 0.35F);
}

TEST(HoughSpace, TheKernelEndsAtItsReach) {
  EXPECT_FLOAT_EQ(vote_kernel(0.0F, 0.02F), 1.0F);
  EXPECT_NEAR(vote_kernel(0.02F * 0.02F, 0.02F), std::exp(-0.5F), 0.11F);
  EXPECT_EQ(vote_kernel(0.0501F * 0.0501F, 0.02F), 0.0F);
}

}  // namespace
}  // namespace houghstream
