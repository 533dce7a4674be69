#include "detector/voting/mean_shift.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <numeric>

#include "pipeline/base/random.hpp"
#include "tests/detector/small_camera.hpp"

namespace houghstream {
namespace {

constexpr float kSigma = 0.016F;

/// Votes about a point, all in one row of cells.
HoughSpace random_space(const Eigen::Vector3f& about, int count) {
  Random random(11);
  HoughSpace space;
  for (int v = 0; v < count; ++v) {
    const auto spread = [&] { return static_cast<float>(random.uniform(-0.05, 0.05)); };
    space.votes.push_back(
        {about + Eigen::Vector3f(spread(), spread(), spread()), static_cast<float>(random.uniform(0.001, 0.1))});
  }
  space.votes.resize(space.votes.size() + kVotePadding, {Eigen::Vector3f::Ones(), 1.0F});
  return space;
}

/// Reference implementation of sum_support, one vote after another.
VoteSupport reference_support(const HoughSpace& space, const std::vector<VoteRange>& ranges,
                              const Eigen::Vector3f& centre) {
  SumLanes lanes{};
  for (const VoteRange& range : ranges) {
    for (std::uint32_t v = range.begin; v < range.end; ++v) {
      const Vote& vote = space.votes[v];
      const Eigen::Vector3f from = vote.centre_camera - centre;
      const float distance_sq = (from.x() * from.x() + from.y() * from.y()) + from.z() * from.z();
      const float k = vote_kernel(distance_sq, kSigma) * vote.weight;
      const std::size_t lane = (v - range.begin) % kSumLanes;
      for (int i = 0; i < 3; ++i) lanes[static_cast<std::size_t>(i)][lane] += k * vote.centre_camera[i];
      lanes[3][lane] += k;
    }
  }
  const auto sum = [&](std::size_t i) {
    const std::array<float, kSumLanes>& l = lanes[i];
    return ((l[0] + l[1]) + (l[2] + l[3])) + ((l[4] + l[5]) + (l[6] + l[7]));
  };
  return {{sum(0), sum(1), sum(2)}, sum(3)};
}

TEST(MeanShift, ManyAtOnceAreAsOneByOneOnEveryMachine) {
  const Eigen::Vector3f about(0.1F, -0.05F, 0.8F);
  const HoughSpace space = random_space(about, 1000);
  const std::vector<VoteRange> ranges = {{0, 1}, {1, 1}, {5, 20}, {20, 341}, {400, 408}, {993, 1000}};
  const Eigen::Vector3f centre = about + Eigen::Vector3f(0.01F, 0.0F, -0.01F);
  const VoteSupport reference = reference_support(space, ranges, centre);
  EXPECT_GT(reference.total, 0.0F);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // the next call selects the target again
    const VoteSupport fast = sum_support(space, ranges, centre, kSigma);
    EXPECT_EQ(fast.total, reference.total);
    EXPECT_EQ(fast.moment, reference.moment);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

TEST(MeanShift, SupportIsTheKernelTimesTheWeight) {
  const HoughSpace space = random_space({0, 0, 1}, 100);
  const VoteSupport support = sum_support(space, {{0, 100}}, {0, 0, 1}, kSigma);
  double total = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (std::size_t v = 0; v < 100; ++v) {
    const Vote& vote = space.votes[v];
    const double k = vote_kernel((vote.centre_camera - Eigen::Vector3f(0, 0, 1)).squaredNorm(), kSigma) * vote.weight;
    total += k;
    moment += k * vote.centre_camera.cast<double>();
  }
  EXPECT_NEAR(support.total, total, 1e-5 * total);
  EXPECT_LT((support.moment.cast<double>() - moment).norm(), 1e-5 * moment.norm());
}

TEST(MeanShift, RangesAreTheRowsOfAWindowInsideTheImage) {
  HoughSpace space;
  space.width = 5;
  space.height = 4;
  space.cell_px = 2;
  space.first_vote.resize(21);
  std::iota(space.first_vote.begin(), space.first_vote.end(), 0U);  // one vote a cell
  std::vector<VoteRange> ranges(7);
  ranges_of_cells(space, 4, 0, 1, ranges);
  ASSERT_EQ(ranges.size(), 2U);
  EXPECT_EQ(ranges[0].begin, 3U);
  EXPECT_EQ(ranges[0].end, 5U);
  EXPECT_EQ(ranges[1].begin, 8U);
  EXPECT_EQ(ranges[1].end, 10U);
  ranges_of_cells(space, 9, 1, 2, ranges);
  EXPECT_TRUE(ranges.empty());
}

TEST(MeanShift, ClimbsToTheMiddleOfACluster) {
  HoughSpace space;
  space.width = 80;
  space.height = 60;
  space.cell_px = 2;
  space.first_vote.assign(80 * 60 + 1, 0);
  space.votes.push_back({{0.0F, 0.0F, 1.0F}, 0.5F});
  space.votes.push_back({{0.004F, 0.0F, 1.0F}, 0.5F});
  std::fill(space.first_vote.begin() + 30 * 80 + 41, space.first_vote.end(), 2U);  // both in cell (40, 30)
  space.votes.resize(2 + kVotePadding);
  std::vector<VoteRange> ranges;
  const Eigen::Vector3f top = seek_mode(space, toy::kSmallCamera, {0.015F, 0.01F, 1.01F}, kSigma, ranges);
  EXPECT_LT((top - Eigen::Vector3f(0.002F, 0.0F, 1.0F)).norm(), 0.001F) << top.transpose();
  const Eigen::Vector3f alone(-0.3F, 0.1F, 1.0F);
  EXPECT_EQ(seek_mode(space, toy::kSmallCamera, alone, kSigma, ranges), alone);
}

}  // namespace
}  // namespace houghstream
