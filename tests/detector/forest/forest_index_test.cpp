#include "detector/forest/forest_index.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace houghstream {
namespace {

TEST(ForestIndex, LeafHeadsTellWhatALeafKnowsBestAndWhereItsClassesBegin) {
  Forest forest;
  forest.classes.resize(2);
  forest.leaves = {0, 2, 2, 3};
  forest.leaf_classes.resize(3);
  forest.leaf_classes[0].probability = 0.2F;
  forest.leaf_classes[1].probability = 0.7F;
  forest.leaf_classes[1].class_index = 1;
  forest.leaf_classes[2].probability = 0.1F;
  const ForestIndex index(forest);
  std::vector<float> certainties;
  std::vector<std::uint32_t> firsts;
  for (const LeafSummary& head : index.leaf_summaries()) {
    certainties.push_back(head.max_posterior);
    firsts.push_back(head.first_class);
  }
  EXPECT_EQ(certainties, (std::vector<float>{0.7F, 0.0F, 0.1F, 0.0F}));
  EXPECT_EQ(firsts, forest.leaves);
}

/// Returns a view of the class, turned by so many radians.
ViewTemplate rotated_view(std::uint32_t class_index, float angle_rad) {
  ViewTemplate view;
  view.class_index = class_index;
  view.R_ray_object = Eigen::AngleAxisf(angle_rad, Eigen::Vector3f::UnitY());
  return view;
}

TEST(ForestIndex, ViewsHaveTheNearestOfTheirClassAsNeighbours) {
  Forest forest;
  forest.classes.resize(2);
  for (const float angle_rad : {0.0F, 0.5F, 0.2F}) forest.views.push_back(rotated_view(0, angle_rad));
  forest.views.push_back(rotated_view(1, 0.1F));
  const ForestIndex index(forest);
  const std::vector<ViewNeighbours>& neighbours = index.view_neighbours();
  ASSERT_EQ(neighbours.size(), 4U);
  EXPECT_EQ(neighbours[0], (ViewNeighbours{2, 1, 0, 0, 0, 0}));
  EXPECT_EQ(neighbours[1], (ViewNeighbours{2, 0, 1, 1, 1, 1}));
  EXPECT_EQ(neighbours[3], (ViewNeighbours{3, 3, 3, 3, 3, 3}));
}

TEST(ForestIndex, MoreAttitudesOfAClassAreSearchedTheMoreViewsItHas) {
  Forest forest;
  forest.classes.resize(3);
  const std::array<std::size_t, 3> views = {108, 300, 500};
  for (std::uint32_t class_index = 0; class_index < views.size(); ++class_index)
    forest.views.insert(forest.views.end(), views[class_index], rotated_view(class_index, 0.0F));
  const ForestIndex index(forest);
  EXPECT_EQ(index.attitude_factor(0), 1.0F);
  EXPECT_FLOAT_EQ(index.attitude_factor(1), 2.0F);
  EXPECT_FLOAT_EQ(index.attitude_factor(2), 3.0F);
}

TEST(ForestIndex, ViewsThatStandForAllAttitudesLieFarApart) {
  Forest forest;
  forest.classes.resize(3);
  for (const float angle_rad : {0.0F, 0.1F, 0.9F, 0.5F}) forest.views.push_back(rotated_view(0, angle_rad));
  forest.views.push_back(rotated_view(1, 0.1F));
  const ForestIndex index(forest);
  EXPECT_EQ(index.sampled_views(0).views, (std::vector<std::uint32_t>{0, 2, 3, 1}));
  EXPECT_EQ(index.sampled_views(1).views, std::vector<std::uint32_t>{4});
  EXPECT_TRUE(index.sampled_views(2).views.empty());
}

TEST(ForestIndex, ViewsOfAllAttitudesHaveTheNearestCoarseOne) {
  Forest forest;
  forest.classes.resize(1);
  constexpr float kStep_rad = 0.002F;
  for (std::size_t i = 0; i < 2 * SampledViews::kCount; ++i)
    forest.views.push_back(rotated_view(0, kStep_rad * static_cast<float>(i)));
  const ForestIndex index(forest);
  const SampledViews& sampled = index.sampled_views(0);
  ASSERT_EQ(sampled.views.size(), SampledViews::kCount);
  EXPECT_EQ(std::set<std::uint32_t>(sampled.views.begin(), sampled.views.end()).size(), SampledViews::kCount);
  ASSERT_EQ(sampled.nearest.size(), SampledViews::kCount);
  for (std::size_t i = 0; i < SampledViews::kCount; ++i) {
    ASSERT_LT(sampled.nearest[i], SampledViews::kCoarse);
    const auto coarse = static_cast<float>(sampled.views[sampled.nearest[i]]);
    EXPECT_LT(std::abs(coarse - static_cast<float>(sampled.views[i])), 400.0F / (SampledViews::kCoarse - 1)) << i;
    EXPECT_TRUE(i >= SampledViews::kCoarse || sampled.nearest[i] == i) << i << " is the nearest to itself";
  }
}

TEST(ForestIndex, AForestWithoutLeavesHasNoHeads) {
  const Forest forest;
  const ForestIndex index(forest);
  EXPECT_TRUE(index.leaf_summaries().empty());
  EXPECT_TRUE(index.packed().nodes.empty());
  EXPECT_TRUE(index.view_neighbours().empty());
}

}  // namespace
}  // namespace houghstream
