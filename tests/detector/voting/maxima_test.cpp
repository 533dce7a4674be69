#include "detector/voting/maxima.hpp"

#include <gtest/gtest.h>

#include "tests/detector/small_camera.hpp"

namespace houghstream {
namespace {

struct Placed {
  int x;
  int y;  // cells
  float depth;
  float weight;
};

/// Votes at the centres of cells, in reading order; the image is not smoothed.
HoughSpace space_of(const std::vector<Placed>& placed) {
  HoughSpace space;
  space.width = 80;
  space.height = 60;
  space.cell_px = 2;
  space.image.assign(80 * 60, 0.0F);
  space.first_vote.assign(80 * 60 + 1, 0);
  for (const Placed& p : placed) {
    const auto cell = static_cast<std::size_t>(p.y * 80 + p.x);
    space.votes.push_back(
        {toy::kSmallCamera.backproject(2 * p.x + 0.5, 2 * p.y + 0.5, p.depth).cast<float>(), p.weight});
    space.image[cell] += p.weight;
    for (std::size_t c = cell + 1; c < space.first_vote.size(); ++c) ++space.first_vote[c];
  }
  space.votes.resize(space.votes.size() + kVotePadding);
  return space;
}

std::vector<Eigen::Vector3f> maxima_of(const HoughSpace& space, int limit = 24) {
  MaximaWorkspace workspace;
  return find_maxima(space, toy::kSmallCamera, {}, limit, workspace);
}

TEST(Maxima, TheHighestComesFirst) {
  const std::vector<Eigen::Vector3f> found = maxima_of(space_of({{10, 10, 1.0F, 0.2F}, {60, 10, 1.0F, 0.5F}}));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_GT(found[0].x(), 0.2F);
  EXPECT_LT(found[1].x(), -0.2F);
}

TEST(Maxima, OfEqualNeighboursTheFirstCounts) {
  EXPECT_EQ(maxima_of(space_of({{20, 10, 1.0F, 0.2F}, {21, 10, 1.5F, 0.2F}})).size(), 1U);
}

TEST(Maxima, ThoseThatMeetAreOne) {
  // The maxima are two cells apart: 3 cm, within reach of each other.
  EXPECT_EQ(maxima_of(space_of({{20, 10, 1.0F, 0.2F}, {22, 10, 1.0F, 0.2F}})).size(), 1U);
}

TEST(Maxima, TheMedianDepthIsWhereTheClimbStarts) {
  const HoughSpace space = space_of({{20, 10, 0.7F, 0.1F}, {20, 10, 1.2F, 0.5F}, {20, 10, 1.4F, 0.2F}});
  const std::vector<Eigen::Vector3f> found = maxima_of(space);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].z(), 1.2F, 1e-3F);
}

TEST(Maxima, LowOnesAndTooManyAreNotLookedAt) {
  const HoughSpace space = space_of({{10, 10, 1.0F, 1.0F}, {40, 10, 1.0F, 0.5F}, {70, 10, 1.0F, 0.05F}});
  EXPECT_EQ(maxima_of(space).size(), 2U);
  EXPECT_EQ(maxima_of(space, 1).size(), 1U);
  EXPECT_TRUE(maxima_of(space_of({})).empty());
}

TEST(Maxima, OfManyClassesFewerOfEachAreLookedAt) {
  EXPECT_EQ(per_class_budget(1, 24), 24);
  EXPECT_EQ(per_class_budget(4, 24), 24);
  EXPECT_EQ(per_class_budget(6, 24), 16);
  EXPECT_EQ(per_class_budget(40, 24), 6);
  EXPECT_EQ(per_class_budget(40, 5), 5) << "no more than asked for";
}

}  // namespace
}  // namespace houghstream
