#include "detector/forest/seen_patches.hpp"

#include <gtest/gtest.h>

#include "detector/detector.hpp"
#include "detector/features/features.hpp"
#include "detector/training/forest_trainer.hpp"
#include "tests/detector/read_beliefs.hpp"
#include "tests/detector/same_detections.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

const Forest& toy_forest() {
  static const Forest forest = train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  return forest;
}

/// One tile in a room that is too far away for the near level: most of that one's picture is looked at by nobody.
RgbdFrame tile_in_a_room() {
  RgbdFrame frame = toy::room(90);
  toy::put_tile(0, 100.0, 90.0, 0.7, frame);
  return frame;
}

/// A frame that differs from it everywhere and has patches everywhere at both levels: what it leaves in memory that is
/// kept from frame to frame is wrong for any other.
RgbdFrame other_frame() {
  RgbdFrame frame = toy::room(91);
  cv::Mat(frame.depth.rowRange(0, 120)).setTo(0.8F);
  return frame;
}

/// Every patch walks down all trees, and believes in whatever class it has seen at all.
DetectionSettings curious() {
  DetectionSettings settings;
  settings.first_trees = 0;
  settings.min_class_share = 1e-6F;
  return settings;
}

SeenPatches seen_in(const RgbdFrame& frame, const DetectionSettings& settings) {
  StageClock clock;
  SeenPatches seen;
  classify_patches(toy_forest(), frame, settings, clock, seen);
  return seen;
}

/// The patches' levels, with features of whole images, whoever looks at them.
std::vector<FeatureImage> whole_images(const RgbdFrame& frame) {
  std::vector<FeatureImage> images;
  for (const FeatureLevel& level : feature_levels(toy_forest().features)) {
    const WorkingFrame working = make_working_frame(frame, level.scale, toy_forest().features);
    images.push_back(compute_features(working, toy_forest().features, 1));
  }
  return images;
}

TEST(SeenPatches, LeavesInWantedTilesAreThoseInWholeImages) {
  const RgbdFrame frame = tile_in_a_room();
  const std::vector<FeatureImage> whole = whole_images(frame);
  DetectionSettings settings = curious();
  for (const int threads : {1, 3}) {
    settings.threads = threads;
    seen_in(other_frame(), settings);
    const SeenPatches seen = seen_in(frame, settings);
    PatchBeliefs expected;
    classify(toy_forest(), whole, seen.grid, settings, expected);
    for (int c = 0; c < 2; ++c) {
      const std::vector<Belief> wanted = beliefs_in(c, expected);
      EXPECT_GT(wanted.size(), 100U) << c;
      EXPECT_TRUE(beliefs_in(c, seen.beliefs) == wanted) << c << ", threads " << threads;
    }
  }
}

TEST(SeenPatches, EveryLeafOfEveryTreeIsFoundInWantedTilesAlone) {
  const RgbdFrame frame = tile_in_a_room();
  const Forest& forest = toy_forest();
  const SeenPatches seen = seen_in(frame, curious());
  const std::vector<FeatureLevel> levels = feature_levels(forest.features);
  const std::vector<FeatureImage> whole = whole_images(frame);
  std::vector<FeatureImage> wanted(levels.size());
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const WorkingFrame other = make_working_frame(other_frame(), levels[l].scale, forest.features);
    wanted[l] = compute_features(other, forest.features, 1);
    FeatureTiles tiles;
    tiles.clear(other.colour.size());
    for (std::size_t p = 0; p < seen.grid.size(); ++p) {
      if (seen.grid.level[p] != l) continue;
      tiles.add_patch(seen.grid.x[p], seen.grid.y[p], farthest_offset(forest.patch, seen.grid.scale[p]));
    }
    compute_features(make_working_frame(frame, levels[l].scale, forest.features), forest.features, tiles, 2, wanted[l]);
  }
  EXPECT_NE(*wanted[0].at(wanted[0].width() - 1, 0), *whole[0].at(whole[0].width() - 1, 0));  // nobody looks there
  int wrong = 0;
  for (std::size_t p = 0; p < seen.grid.size(); ++p) {
    const std::size_t l = seen.grid.level[p];
    const auto leaf = [&](const FeatureImage& image, int tree) {
      return find_leaf(forest, tree, image.patch(seen.grid.x[p], seen.grid.y[p], seen.grid.scale[p]));
    };
    for (int tree = 0; tree < static_cast<int>(forest.roots.size()); ++tree) {
      wrong += leaf(wanted[l], tree) == leaf(whole[l], tree) ? 0 : 1;
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << seen.grid.size() << " patches";
}

TEST(SeenPatches, DetectionsInWantedTilesAreThoseInWholeImages) {
  DetectionSettings settings;
  settings.first_trees = 1;  // the toy forest has few
  const Detector detector(toy_forest(), settings);
  detector.detect(other_frame());
  const Detections found = detector.detect(tile_in_a_room());
  settings.readable = true;  // features of whole images
  const Detections expected = Detector(toy_forest(), settings).detect(tile_in_a_room());
  ASSERT_FALSE(expected.detections.empty());
  expect_same(found, expected);
}

TEST(SeenPatches, ColourAndCameraAreThoseOfTheNearLevel) {
  const RgbdFrame frame = tile_in_a_room();
  const SeenPatches seen = seen_in(frame, curious());
  const WorkingFrame near = make_working_frame(frame, feature_levels(toy_forest().features)[0].scale, {});
  EXPECT_EQ(seen.hough_camera.fx, near.camera.fx);
  EXPECT_EQ(seen.hough_camera.width, near.camera.width);
  ASSERT_EQ(seen.colour.size(), near.colour.size());
  EXPECT_EQ(cv::norm(seen.colour, near.colour, cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace houghstream
