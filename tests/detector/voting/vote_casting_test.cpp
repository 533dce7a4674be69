#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "detector/voting/hough_space.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

const Camera kHalfVga{320, 240, 262.5, 262.5, 159.5, 119.5};

/// Leaves of 0 to 12 votes anywhere about a patch.
Forest random_forest(Random& random) {
  Forest forest;
  forest.roots = {-1, -1, -1};
  for (int leaf = 0; leaf < 200; ++leaf) {
    LeafClass entry;
    entry.vote_count = static_cast<std::uint8_t>(random.below(13));
    entry.probability = static_cast<float>(random.uniform(0.1, 1.0));
    forest.leaf_classes.push_back(entry);
    const auto offset = [&] { return static_cast<float>(random.uniform(-0.3, 0.3)); };
    for (int v = 0; v < entry.vote_count; ++v) {
      forest.votes.emplace_back(Eigen::Vector3f(offset(), offset(), offset()),
                                static_cast<float>(random.uniform(0.01, 1.0)));
    }
  }
  return forest;
}

/// Returns one vote, as vote casting is to compute it.
Vote vote_of(const Forest& forest, const LeafClass& entry, const LeafVote& leaf_vote, const Eigen::Vector3f& point) {
  const float fraction = 1.0F / static_cast<float>(forest.roots.size());
  const Eigen::Matrix3f R = ray_rotation(point);
  const Eigen::Vector3f o = leaf_vote.offset();
  Eigen::Vector3f centre;
  for (int i = 0; i < 3; ++i) centre[i] = point[i] + (R(i, 0) * o.x() + (R(i, 1) * o.y() + R(i, 2) * o.z()));
  return {centre, entry.probability * leaf_vote.weight.value() * fraction};
}

/// Returns an entry of the forest's leaves with its place.
SupportingEntry entry_of(const Forest& forest, std::size_t number) {
  LeafStart start;
  for (std::size_t e = 0; e < number; ++e) start.pass(forest.leaf_classes[e]);
  return {start, forest.leaf_classes[number]};
}

std::uint32_t cell_of(const Eigen::Vector3f& centre, const CellGrid& grid) {
  const float scale = 1.0F / centre.z();
  const float x = grid.fx * centre.x() * scale + grid.cx;
  const float y = grid.fy * centre.y() * scale + grid.cy;
  const bool seen = centre.z() >= 0.1F && x >= 0.0F && y >= 0.0F && x < static_cast<float>(grid.width) &&
                    y < static_cast<float>(grid.height);
  return seen ? static_cast<std::uint32_t>(static_cast<int>(y) * grid.width + static_cast<int>(x)) : grid.outside();
}

void expect_as_one_by_one(const Forest& forest, const PatchGrid& patches, const std::vector<Voter>& voters) {
  const CellGrid grid(kHalfVga, 2);
  CastVotes cast;
  cast_all({forest, patches, voters, grid}, cast);
  std::size_t v = 0;
  std::size_t outside = 0;
  for (std::uint32_t i = 0; i < voters.size(); ++i) {
    const LeafClass& entry = voters[i].entry.leaf_class;
    const std::uint32_t first = voters[i].entry.start.vote;
    for (std::uint32_t l = first; l < first + entry.vote_count; ++l, ++v) {
      ASSERT_LT(v, cast.count);
      const Vote expected = vote_of(forest, entry, forest.votes[l], patches.point_camera[voters[i].patch]);
      ASSERT_EQ(cast.votes[v].centre_camera, expected.centre_camera) << v;
      ASSERT_EQ(cast.votes[v].weight, expected.weight) << v;
      ASSERT_EQ(cast.cells[v], cell_of(expected.centre_camera, grid));
      ASSERT_EQ(cast.voters[v], i);
      outside += cast.cells[v] == grid.outside() ? 1 : 0;
    }
  }
  EXPECT_EQ(cast.count, v);
  EXPECT_GT(outside, 100U);
}

TEST(VoteCasting, ManyAtOnceAreAsOneByOneOnEveryMachine) {
  Random random(3);
  const Forest forest = random_forest(random);
  PatchGrid patches;
  std::vector<Voter> voters;
  for (std::uint32_t p = 0; p < 300; ++p) {
    patches.point_camera.emplace_back(random.uniform(-0.5, 0.5), random.uniform(-0.4, 0.4), random.uniform(0.3, 1.5));
    for (int t = 0; t < 3; ++t) voters.push_back({p, entry_of(forest, static_cast<std::size_t>(random.below(200)))});
  }
  voters.push_back({299, entry_of(forest, 199)});  // its votes are the forest's last
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // the next call selects the target again
    expect_as_one_by_one(forest, patches, voters);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

TEST(VoteCasting, NobodyCastsNothing) {
  CastVotes cast;
  cast.count = 7;
  cast_all({{}, {}, {}, CellGrid(kHalfVga, 2)}, cast);
  EXPECT_EQ(cast.count, 0U);
}

TEST(VoteCasting, CellsAreThoseOfTheCamerasPixels) {
  const CellGrid grid({101, 80, 100.0, 90.0, 49.5, 39.5}, 2);
  EXPECT_EQ(grid.width, 51);
  EXPECT_EQ(grid.height, 40);
  EXPECT_EQ(cell_of({0.1F, 0.05F, 1.0F}, grid), 22U * 51U + 30U);  // pixel (59.5, 44)
}

}  // namespace
}  // namespace houghstream
