#include "detector/forest/posteriors.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/detector/listed_voters.hpp"

namespace houghstream {
namespace {

/// Returns two trees; leaf 0 is certain of the first class by 0.8 and of the second one by 0.2, leaf 1 of the second by
/// 0.6, leaf 2 knows background only.
Forest three_leaves() {
  Forest forest;
  forest.classes.resize(2);
  forest.roots = {-1, -2};
  forest.leaves = {0, 2, 3, 3};
  forest.leaf_classes.resize(3);
  forest.leaf_classes[0].probability = 0.8F;
  forest.leaf_classes[1].probability = 0.2F;
  forest.leaf_classes[1].class_index = 1;
  forest.leaf_classes[2].probability = 0.6F;
  forest.leaf_classes[2].class_index = 1;
  for (LeafClass& entry : forest.leaf_classes) entry.vote_count = 1;  // so that their places differ
  forest.votes.resize(3);
  return forest;
}

/// Returns the indices into Forest::leaf_classes of the entries by which a patch votes.
std::vector<std::uint32_t> entries_of(const ListedVoter& voter) {
  std::vector<std::uint32_t> entries;
  for (const SupportingEntry& entry : voter.entries) entries.push_back(entry.start.vote);
  return entries;
}

TEST(Posteriors, APatchVotesByTheMeanOfItsTrees) {
  const Forest forest = three_leaves();
  const ForestIndex index(forest);
  const std::vector<std::int32_t> first = {0, 0, 2, 1, 2, 2};  // tree by tree: patches see (0,1), (0,2) and (2,2)
  const std::vector<std::int32_t> second = {0, 0};             // (0,0)
  PatchPosteriors posteriors(index, 2, 0.35F);
  const std::vector<std::uint32_t> patches = {0, 1, 2, 3};
  posteriors.note({1, 1, &patches[3], second.data()});
  posteriors.note({0, 3, patches.data(), first.data()});
  const std::vector<ListedVoter> one = voters_for(0, posteriors);
  ASSERT_EQ(one.size(), 3U);
  EXPECT_EQ(one[0].patch, 0U);
  EXPECT_EQ(entries_of(one[0]), (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(one[1].patch, 1U);
  EXPECT_EQ(one[2].patch, 3U);
  EXPECT_EQ(entries_of(one[2]), (std::vector<std::uint32_t>{0, 0}));
  const std::vector<ListedVoter> other = voters_for(1, posteriors);  // 0.4, 0.1, 0 and 0.2
  ASSERT_EQ(other.size(), 1U);
  EXPECT_EQ(other[0].patch, 0U);
  EXPECT_EQ(entries_of(other[0]), (std::vector<std::uint32_t>{1, 2}));
}

TEST(Posteriors, AShareThatIsJustReachedIsEnough) {
  const Forest forest = three_leaves();
  const ForestIndex index(forest);
  const std::vector<std::int32_t> leaves = {0, 2};
  const float fraction = 0.8F / 2.0F;
  PatchPosteriors posteriors(index, 1, fraction);
  const std::uint32_t patch = 0;
  posteriors.note({0, 1, &patch, leaves.data()});
  EXPECT_EQ(voters_for(0, posteriors).size(), 1U);
  PatchPosteriors stricter(index, 1, std::nextafter(fraction, 1.0F));
  stricter.note({0, 1, &patch, leaves.data()});
  EXPECT_TRUE(voters_for(0, stricter).empty());
}

TEST(Posteriors, PatchesThatWereGivenUpLeaveGaps) {
  const Forest forest = three_leaves();
  const ForestIndex index(forest);
  const std::vector<std::uint32_t> patches = {5, 9};
  const std::vector<std::int32_t> leaves = {0, 0, 0, 1};
  PatchPosteriors posteriors(index, 1, 0.4F);
  posteriors.note({0, 2, patches.data(), leaves.data()});
  const std::vector<ListedVoter> found = voters_for(0, posteriors);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].patch, 5U);
  EXPECT_EQ(found[1].patch, 9U);
}

TEST(Posteriors, EndWithTheNextFrame) {
  const Forest forest = three_leaves();
  const ForestIndex index(forest);
  const std::uint32_t patch = 0;
  const std::vector<std::int32_t> leaves = {0, 0};
  PatchPosteriors posteriors(index, 1, 0.4F);
  posteriors.note({0, 1, &patch, leaves.data()});
  posteriors.reset(index, 2, 0.4F, 1);
  EXPECT_TRUE(voters_for(0, posteriors).empty());
  posteriors.note({1, 1, &patch, leaves.data()});
  EXPECT_EQ(voters_for(0, posteriors).size(), 1U);
}

TEST(Posteriors, NobodyVotesBeforeARunIsNoted) {
  const PatchPosteriors none;
  EXPECT_TRUE(voters_for(0, none).empty());
}

}  // namespace
}  // namespace houghstream
