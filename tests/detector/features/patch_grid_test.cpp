#include "detector/features/patch_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace houghstream {
namespace {

const FeatureLevel kEverything{1.0F, 1.0F, 0.0F, 10.0F};

/// Returns a wall at one distance, seen by a camera of 100 pixels focal length.
PatchGrid wall(float distance, const PatchSpacing& spacing) {
  WorkingFrame frame;
  frame.camera = {128, 96, 100, 100, 63.5, 47.5};
  frame.filled_depth = cv::Mat(96, 128, CV_32FC1, cv::Scalar(distance));
  PatchGrid grid;
  add_patches(frame, kEverything, 0, {PatchSettings{}, spacing}, grid);
  return grid;
}

std::set<std::pair<int, int>> places(const PatchGrid& grid) {
  std::set<std::pair<int, int>> out;
  for (std::size_t p = 0; p < grid.size(); ++p) out.emplace(grid.x[p], grid.y[p]);
  return out;
}

/// Returns a wall two metres away, in any view of the camera.
WorkingFrame wall(const Camera& camera) {
  WorkingFrame frame;
  frame.camera = camera;
  frame.filled_depth = cv::Mat(camera.height, camera.width, CV_32FC1, cv::Scalar(2.0));
  return frame;
}

double nearest_neighbour(const PatchGrid& grid) {
  double nearest = 1e9;
  for (std::size_t p = 1; p < grid.size(); ++p) {
    nearest = std::min(nearest, std::hypot(grid.x[p] - grid.x[0], grid.y[p] - grid.y[0]));
  }
  return nearest;
}

TEST(PatchGrid, ItsRunsHoldAllPatchesInTheirOrderLevelByLevel) {
  WorkingFrame frame = wall({96, 48, 60, 60, 47.5, 23.5});
  frame.filled_depth(cv::Rect(10, 0, 60, 48)).setTo(std::numeric_limits<float>::quiet_NaN());
  PatchGrid grid;
  for (const std::uint8_t level : {std::uint8_t{0}, std::uint8_t{1}}) {
    add_patches(frame, {0.5F, 1.0F, 0.0F, 3.0F}, level, {PatchSettings{}, {1, 0.0F}}, grid);
  }
  ASSERT_EQ(grid.size(), 2U * 36U * 48U);
  std::size_t next = 0;
  std::vector<PatchRun> runs = {{7, 7}};
  list_runs(grid, runs);
  for (const PatchRun& run : runs) {
    EXPECT_EQ(run.first, next);
    EXPECT_GT(run.count, 0U);
    EXPECT_EQ(grid.level[run.first], grid.level[run.first + run.count - 1]);
    next += run.count;
  }
  EXPECT_EQ(next, grid.size());
}

TEST(PatchGrid, EveryPixelIsAPlaceOfAScaleSpaceSquareBySquare) {
  WorkingFrame frame;
  frame.filled_depth = cv::Mat(40, 70, CV_32FC1, cv::Scalar(1.0));
  PatchGrid grid;
  add_patches_everywhere(frame, {}, PatchSettings{}, 1, grid);
  ASSERT_EQ(grid.size(), 40U * 70U);
  EXPECT_EQ(places(grid).size(), grid.size());
  EXPECT_EQ(grid.x[32], 0);  // the second row of the first square
  EXPECT_EQ(grid.y[32], 1);
  EXPECT_EQ(grid.x[32 * 32], 32);
}

TEST(PatchGrid, TilesAreWantedAsFarAsPatchesLook) {
  WorkingImages images;
  images.levels = {{0.5F, 1.0F, 0.0F, 3.0F}, {1.0F, 1.0F, 3.0F, 9.0F}};
  images.frames = {wall({96, 48, 60, 60, 47.5, 23.5}), wall({192, 96, 120, 120, 95.5, 47.5})};
  for (WorkingFrame& frame : images.frames) frame.colour.create(frame.filled_depth.size(), CV_8UC3);
  images.frames[0].filled_depth.colRange(20, 96).setTo(std::numeric_limits<float>::quiet_NaN());
  PatchGrid grid;
  place_patches(images, {PatchSettings{}, {2, 0.0F}}, grid);
  place_patches(images, {PatchSettings{}, {2, 0.0F}}, grid);  // in the same memory
  ASSERT_EQ(grid.size(), 10U * 24U);
  ASSERT_EQ(grid.tiles.size(), 2U);
  std::vector<cv::Rect> near;
  std::vector<cv::Rect> far;
  grid.tiles[0].list_parts(0, 128, near);
  grid.tiles[1].list_parts(0, 128, far);
  EXPECT_EQ(near, (std::vector<cv::Rect>{{0, 0, 32, 32}}));  // patches of 10 steps look less than a pixel far
  EXPECT_TRUE(far.empty());
}

TEST(PatchGrid, StandsOnDepthThatItsLevelHolds) {
  WorkingFrame frame = wall({64, 48, 60, 60, 31.5, 23.5});
  frame.filled_depth(cv::Rect(0, 0, 32, 48)).setTo(std::numeric_limits<float>::quiet_NaN());
  PatchGrid grid;
  add_patches(frame, {0.5F, 1.0F, 0.0F, 1.9F}, 0, {PatchSettings{}, {2, 0.0F}}, grid);
  EXPECT_EQ(grid.size(), 0U);
  add_patches(frame, {0.5F, 1.0F, 1.9F, 3.0F}, 1, {PatchSettings{}, {2, 0.0F}}, grid);
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

TEST(PatchSpacing, PatchesStandAsFarApartAsTheyMay) {
  constexpr float kSpacing = 0.0801F;
  for (const float distance : {0.3F, 0.5F, 0.7F, 1.0F, 1.4F, 2.0F, 2.8F, 3.9F}) {
    SCOPED_TRACE(distance);
    const PatchGrid grid = wall(distance, {2, kSpacing});
    const double apart = nearest_neighbour(grid) * distance / 100.0;
    EXPECT_LE(apart, kSpacing);
    EXPECT_GT(apart * std::sqrt(2.0), kSpacing);
    EXPECT_NEAR(std::sqrt(grid.area[0]), apart, 1e-5);
    EXPECT_NEAR(grid.cell_px[0].width, apart * 100.0 / distance, 1e-4);
    EXPECT_NEAR(grid.cell_px[0].x + 0.5F * grid.cell_px[0].width, grid.x[0] + 0.5F, 1e-4);
  }
}

TEST(PatchSpacing, BeyondItTheStrideDecides) {
  EXPECT_EQ(places(wall(4.1F, {2, 0.08F})), places(wall(4.1F, {2, 0.0F})));
  EXPECT_EQ(wall(4.1F, {2, 0.08F}).size(), 64U * 48U);
}

TEST(PatchSpacing, EachThinningLeavesHalfOfThePatches) {
  std::set<std::pair<int, int>> before = places(wall(4.1F, {2, 0.08F}));
  for (const float distance : {2.8F, 1.9F, 1.4F, 0.99F}) {
    SCOPED_TRACE(distance);
    const std::set<std::pair<int, int>> left = places(wall(distance, {2, 0.08F}));
    EXPECT_EQ(left.size(), before.size() / 2);
    EXPECT_TRUE(std::includes(before.begin(), before.end(), left.begin(), left.end()));
    before = left;
  }
}

TEST(PatchSpacing, OfEveryDistanceSomePatchesAreLeft) {
  EXPECT_EQ(wall(0.001F, {2, 0.08F}).size(), 4U * 3U);
}

TEST(PatchSpacing, AreasAddUpToTheSurface) {
  const float step = 1.4F / 100.0F;
  const PatchGrid grid = wall(1.4F, {2, 0.08F});
  float sum = 0.0F;
  for (const float area : grid.area) sum += area;
  EXPECT_NEAR(sum, 128 * 96 * step * step, 1e-3);
}

}  // namespace
}  // namespace houghstream
