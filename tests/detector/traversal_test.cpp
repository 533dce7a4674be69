#include "detector/traversal.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "detector/features.hpp"
#include "detector/forest_trainer.hpp"
#include "toy_data.hpp"

namespace houghstream {
namespace {

TEST(Traversal, ManyPatchesAtOnceReachTheLeavesOfOneAtATime) {
  const Forest forest = train_forest(toy::training_views(), {}, {}, toy::quick_training(), [](const auto&) {});
  RgbdFrame room = toy::room(5);
  toy::put_tile(1, 150, 100, 0.8, room);
  const WorkingFrame frame = make_working_frame(room, forest.features);
  const FeatureImage features = compute_features(frame, forest.features);
  const PatchGrid patches = make_patch_grid(frame, forest.patch, 2);
  ASSERT_GT(patches.size(), 4000U);
  for (const int threads : {1, 2}) {
    const std::vector<std::int32_t> leaves = assign_leaves(forest, features, patches, threads);
    ASSERT_EQ(leaves.size(), patches.size() * forest.roots.size());
    for (std::size_t p = 0; p < patches.size(); ++p) {
      for (std::size_t tree = 0; tree < forest.roots.size(); ++tree) {
        const std::int32_t leaf = find_leaf(forest, static_cast<int>(tree), features.at(patches.x[p], patches.y[p]),
                                            patches.scale[p], features.row_stride());
        ASSERT_EQ(leaves[p * forest.roots.size() + tree], leaf) << "patch " << p << " tree " << tree;
      }
    }
  }
}

TEST(PatchGrid, StandsOnKnownDepthOnlyAndKnowsItsPoints) {
  WorkingFrame frame;
  frame.camera = {64, 48, 60, 60, 31.5, 23.5};
  frame.filled_depth = cv::Mat(48, 64, CV_32FC1, cv::Scalar(2.0));
  frame.filled_depth(cv::Rect(0, 0, 32, 48)).setTo(std::numeric_limits<float>::quiet_NaN());
  const PatchGrid grid = make_patch_grid(frame, PatchSettings{}, 2);
  EXPECT_EQ(grid.size(), 16U * 24U);
  EXPECT_GE(*std::min_element(grid.x.begin(), grid.x.end()), 32);
  const Eigen::Vector3d expected = frame.camera.backproject(grid.x[0], grid.y[0], 2.0);
  EXPECT_LT((grid.point_camera[0].cast<double>() - expected).norm(), 1e-6);
}

}  // namespace
}  // namespace houghstream
