#include <gtest/gtest.h>

#include "detector/baseline/study_detector.hpp"
#include "detector/detector.hpp"
#include "detector/stages.hpp"
#include "tests/detector/listed_voters.hpp"
#include "tests/detector/same_detections.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

/// Returns one tile before a background that is too far away for the near level, so that most of that level's image is
/// unused.
RgbdFrame tile_on_a_background() {
  RgbdFrame frame = toy::background(90);
  toy::put_tile(0, 100.0, 90.0, 0.7, frame);
  return frame;
}

/// Returns a frame that differs from it everywhere and has patches everywhere at both levels: what it leaves in memory
/// that is kept from frame to frame is wrong for any other.
RgbdFrame other_frame() {
  RgbdFrame frame = toy::background(91);
  cv::Mat(frame.depth.rowRange(0, 120)).setTo(0.8F);
  return frame;
}

/// Every patch walks down all trees, and votes for whatever class its leaves know at all.
DetectionSettings curious() {
  DetectionSettings settings;
  settings.leaves.first_trees = 0;
  settings.leaves.min_class_fraction = 1e-6F;
  return settings;
}

/// The stages up to the leaves.
void see(const RgbdFrame& frame, const DetectionSettings& settings, DetectorWorkspace& workspace) {
  const SearchContext search{toy::forest_index(), settings};
  make_working_images(search, frame, workspace);
  compute_features(search, workspace);
  find_posteriors(search, workspace);
}

/// Returns the patches' levels, with features of whole images, whoever looks at them.
std::vector<FeatureImage> whole_images(const RgbdFrame& frame) {
  std::vector<FeatureImage> images;
  for (const FeatureLevel& level : feature_levels(toy::forest().features, frame.camera)) {
    const WorkingFrame working = make_working_frame(frame, level.scale, toy::forest().features);
    images.push_back(compute_features(working, toy::forest().features, 1));
  }
  return images;
}

TEST(WantedTiles, LeavesInWantedTilesAreThoseInWholeImages) {
  const RgbdFrame frame = tile_on_a_background();
  const std::vector<FeatureImage> whole = whole_images(frame);
  DetectionSettings settings = curious();
  for (const int threads : {1, 3}) {
    settings.threads = threads;
    DetectorWorkspace workspace;
    see(other_frame(), settings, workspace);
    see(frame, settings, workspace);
    LeafWorkspace memory;
    PatchPosteriors expected;
    find_posteriors({toy::forest_index(), whole, workspace.patches, settings.leaves, threads}, memory, expected);
    for (int c = 0; c < 2; ++c) {
      const std::vector<ListedVoter> wanted = voters_for(c, expected);
      EXPECT_GT(wanted.size(), 100U) << c;
      EXPECT_TRUE(voters_for(c, workspace.posteriors) == wanted) << c << ", threads " << threads;
    }
  }
}

TEST(WantedTiles, EveryLeafOfEveryTreeIsFoundInWantedTilesAlone) {
  const RgbdFrame frame = tile_on_a_background();
  const Forest& forest = toy::forest();
  DetectorWorkspace workspace;
  see(frame, curious(), workspace);
  const PatchGrid& patches = workspace.patches;
  const std::vector<FeatureLevel> levels = feature_levels(forest.features, frame.camera);
  const std::vector<FeatureImage> whole = whole_images(frame);
  std::vector<FeatureImage> wanted(levels.size());
  for (std::size_t l = 0; l < levels.size(); ++l) {
    const WorkingFrame other = make_working_frame(other_frame(), levels[l].scale, forest.features);
    wanted[l] = compute_features(other, forest.features, 1);
    const WorkingFrame working = make_working_frame(frame, levels[l].scale, forest.features);
    FeatureWorkspace memory;
    compute_features({working, forest.features, patches.tiles[l]}, 2, memory, wanted[l]);
  }
  EXPECT_NE(*wanted[0].at(wanted[0].width() - 1, 0), *whole[0].at(whole[0].width() - 1, 0));  // nobody looks there
  int wrong = 0;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const std::size_t l = patches.level[p];
    const auto leaf = [&](const FeatureImage& image, int tree) {
      return find_leaf(forest, tree, image.patch(patches.x[p], patches.y[p], patches.scale[p]));
    };
    for (int tree = 0; tree < static_cast<int>(forest.roots.size()); ++tree) {
      wrong += leaf(wanted[l], tree) == leaf(whole[l], tree) ? 0 : 1;
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << patches.size() << " patches";
}

TEST(WantedTiles, DetectionsInThemAreThoseInWholeImages) {
  DetectionSettings settings;
  settings.leaves.first_trees = 1;  // the toy forest has few
  const Detector detector(toy::forest(), settings);
  DetectorWorkspace workspace;
  detector.detect(other_frame(), workspace);
  const Detections found = detector.detect(tile_on_a_background(), workspace);
  const Detections expected =
      baseline::StudyDetector(toy::forest(), settings, baseline::Way::kReference).detect(tile_on_a_background());
  ASSERT_FALSE(expected.detections.empty());
  expect_same(found, expected);
}

}  // namespace
}  // namespace houghstream
