#include "detector/forest/traversal.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "detector/features/features.hpp"
#include "detector/training/forest_trainer.hpp"
#include "toy_data.hpp"

namespace houghstream {
namespace {

TEST(Traversal, ManyPatchesAtOnceReachTheLeavesOfOneAtATime) {
  const Forest forest = train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  RgbdFrame room = toy::room(5);
  toy::put_tile(1, 150, 100, 0.8, room);
  std::vector<FeatureImage> features;
  PatchGrid patches;
  for (const FeatureLevel& level : feature_levels(forest.features)) {
    const WorkingFrame frame = make_working_frame(room, level, forest.features);
    add_patches(frame, level, static_cast<std::uint8_t>(features.size()), forest.patch, 2, patches);
    features.push_back(compute_features(frame, forest.features, 2));
  }
  ASSERT_GT(patches.size(), 4000U);
  for (const int threads : {1, 2}) {
    const std::vector<std::int32_t> leaves = assign_leaves(forest, features, patches, threads);
    ASSERT_EQ(leaves.size(), patches.size() * forest.roots.size());
    for (std::size_t p = 0; p < patches.size(); ++p) {
      for (std::size_t tree = 0; tree < forest.roots.size(); ++tree) {
        const FeatureImage& image = features[patches.level[p]];
        const std::int32_t leaf =
            find_leaf(forest, static_cast<int>(tree), image.patch(patches.x[p], patches.y[p], patches.scale[p]));
        ASSERT_EQ(leaves[p * forest.roots.size() + tree], leaf) << "patch " << p << " tree " << tree;
      }
    }
  }
}

TEST(PatchGrid, StandsOnDepthThatItsLevelHolds) {
  WorkingFrame frame;
  frame.camera = {64, 48, 60, 60, 31.5, 23.5};
  frame.filled_depth = cv::Mat(48, 64, CV_32FC1, cv::Scalar(2.0));
  frame.filled_depth(cv::Rect(0, 0, 32, 48)).setTo(std::numeric_limits<float>::quiet_NaN());
  PatchGrid grid;
  add_patches(frame, {0.5F, 1.0F, 0.0F, 1.9F}, 0, PatchSettings{}, 2, grid);
  EXPECT_EQ(grid.size(), 0U);
  add_patches(frame, {0.5F, 1.0F, 1.9F, 3.0F}, 1, PatchSettings{}, 2, grid);
  ASSERT_EQ(grid.size(), 16U * 24U);
  EXPECT_GE(*std::min_element(grid.x.begin(), grid.x.end()), 32);
  EXPECT_EQ(grid.level[0], 1);
  const Eigen::Vector3d expected = frame.camera.backproject(grid.x[0], grid.y[0], 2.0);
  EXPECT_LT((grid.point_camera[0].cast<double>() - expected).norm(), 1e-6);
  // Two working pixels are four frame pixels; neighbours touch.
  EXPECT_EQ(grid.cell_px[0].width, 4.0F);
  EXPECT_EQ(grid.cell_px[1].x, grid.cell_px[0].br().x);
  EXPECT_NEAR(grid.area[0], 2.0 * 2.0 * 2.0 * 2.0 / 60.0 / 60.0, 1e-6);
}

TEST(FeatureLevels, MeetWithoutAGap) {
  const auto levels = feature_levels(FeatureSettings{});
  EXPECT_TRUE(levels[0].holds(1.2F));
  EXPECT_FALSE(levels[1].holds(1.2F));
  EXPECT_TRUE(levels[1].holds(1.21F));
  EXPECT_FALSE(levels[1].holds(std::numeric_limits<float>::quiet_NaN()));
}

}  // namespace
}  // namespace houghstream
