#include "detector/forest/traversal.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "detector/features/features.hpp"
#include "detector/training/forest_trainer.hpp"
#include "toy_data.hpp"

namespace houghstream {
namespace {

/// All leaves of a grid, patch by patch, as find_leaves and as find_leaves_readably tell them; 0 threads = readably.
std::vector<std::int32_t> leaves_of(const Forest& forest, const std::vector<FeatureImage>& features,
                                    const PatchGrid& patches, int threads) {
  const std::size_t trees = forest.roots.size();
  const std::vector<PatchRun> runs = patch_runs(patches);
  std::vector<std::int32_t> leaves(patches.size() * trees, -1);
  const auto visit = [&](std::size_t run, const std::int32_t* of_run) {
    for (std::size_t i = 0; i < runs[run].count * trees; ++i) {
      const std::size_t patch = runs[run].first + i % runs[run].count;
      leaves[patch * trees + i / runs[run].count] = of_run[i];
    }
  };
  if (threads > 0) {
    find_leaves(forest, features, patches, runs, threads, visit);
  } else {
    find_leaves_readably(forest, features, patches, runs, visit);
  }
  return leaves;
}

void expect_leaves_of_find_leaf(const Forest& forest, const std::vector<FeatureImage>& features,
                                const PatchGrid& patches) {
  for (const int threads : {0, 1, 2}) {
    const std::vector<std::int32_t> leaves = leaves_of(forest, features, patches, threads);
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

class Traversal : public ::testing::Test {
 protected:
  Traversal() { toy::put_tile(1, 150, 100, 0.8, room); }

  const Forest forest = train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  RgbdFrame room = toy::room(5);
};

TEST_F(Traversal, ManyPatchesAtOnceReachTheLeavesOfOneAtATime) {
  std::vector<FeatureImage> features;
  PatchGrid patches;
  for (const FeatureLevel& level : feature_levels(forest.features)) {
    const WorkingFrame frame = make_working_frame(room, level, forest.features);
    add_patches(frame, level, static_cast<std::uint8_t>(features.size()), forest.patch, 2, patches);
    features.push_back(compute_features(frame, forest.features, 2));
  }
  ASSERT_GT(patches.size(), 4000U);
  ASSERT_TRUE(patches.squares.empty());
  expect_leaves_of_find_leaf(forest, features, patches);
}

TEST_F(Traversal, SoDoPatchesAtEveryPixelAndThoseWithGaps) {
  const FeatureLevel level = feature_levels(forest.features)[0];
  const WorkingFrame frame = make_working_frame(room, level, forest.features);
  std::vector<FeatureImage> features;
  features.push_back(compute_features(frame, forest.features, 2));
  PatchSettings pixels = forest.patch;
  pixels.unit = 1.0F;
  for (const int stride : {1, 3}) {
    PatchGrid patches;
    add_patches_everywhere(frame, level, pixels, stride, patches);
    EXPECT_EQ(patches.squares.empty(), stride > 1);
    expect_leaves_of_find_leaf(forest, features, patches);
  }
}

TEST(PatchGrid, ItsSquaresHoldAllPatchesRowByRow) {
  WorkingFrame frame;
  frame.filled_depth = cv::Mat(40, 70, CV_32FC1, cv::Scalar(1.0));
  PatchGrid grid;
  add_patches_everywhere(frame, {}, PatchSettings{}, 1, grid);
  ASSERT_EQ(grid.size(), 40U * 70U);
  ASSERT_EQ(grid.squares.size(), 6U);
  std::size_t next = 0;
  for (const PatchRun& square : patch_runs(grid)) {
    EXPECT_EQ(square.first, next);
    for (std::size_t i = 0; i < square.count; ++i, ++next) {
      EXPECT_EQ(grid.x[next], grid.x[square.first] + static_cast<int>(i) % square.width);
      EXPECT_EQ(grid.y[next], grid.y[square.first] + static_cast<int>(i) / square.width);
    }
  }
  EXPECT_EQ(next, grid.size());
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
