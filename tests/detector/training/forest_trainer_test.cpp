#include "detector/training/forest_trainer.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "detector/detector.hpp"
#include "detector/forest/forest_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/detector/toy_data.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::training {
namespace {

const auto kQuiet = [](const std::string&) {};

std::string file_bytes(const Forest& forest, const std::string& name) {
  const auto file = std::filesystem::temp_directory_path() / name;
  save_forest(forest, file);
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  std::filesystem::remove(file);
  return bytes.str();
}

std::string trained_bytes(int threads, std::uint64_t seed) {
  Profile profile = toy::quick_profile();
  profile.training.threads = threads;
  profile.training.seed = seed;
  return file_bytes(train_forest(toy::training_views(), profile, kQuiet), "houghstream_forest_trainer_test");
}

TEST(ForestTrainer, SameSeedGivesTheSameFileForAnyNumberOfThreads) {
  const std::string serial = trained_bytes(1, 1);
  EXPECT_TRUE(serial == trained_bytes(2, 1));
  EXPECT_TRUE(serial == trained_bytes(4, 1));
  EXPECT_FALSE(serial == trained_bytes(2, 2));
}

TEST(ForestTrainer, LeavesHoldProbabilitiesAndSharesOfVotes) {
  const Forest forest = train_forest(toy::training_views(), toy::quick_profile(), kQuiet);
  EXPECT_EQ(forest.roots.size(), 5U);
  ASSERT_EQ(forest.classes.size(), 2U);
  EXPECT_NEAR(forest.classes[0].radius, 0.085F, 0.015F);  // half the diagonal of a 0.12 m tile
  for (std::size_t l = 1; l < forest.leaves.size(); ++l) {
    float sum = 0.0F;
    for (std::uint32_t e = forest.leaves[l - 1]; e < forest.leaves[l]; ++e) sum += forest.leaf_classes[e].probability;
    EXPECT_LE(sum, 1.0001F);
  }
  LeafStart start;
  for (const LeafClass& entry : forest.leaf_classes) {
    float fraction = 0.0F;
    for (std::uint32_t v = 0; v < entry.vote_count; ++v) fraction += forest.votes.at(start.vote + v).weight.value();
    start.pass(entry);
    EXPECT_GT(fraction, 0.0F);
    EXPECT_LE(fraction, 1.0001F);
  }
}

TEST(ForestTrainer, MoreViewsThanLeavesCanNameAreRefused) {
  std::vector<TrainingView> views = toy::training_views();
  views.resize(LeafView::kMaxViews + views.size(), views.front());  // the first is an object's
  expect_says(error_of([&] { train_forest(views, toy::quick_profile(), kQuiet); }),
              {"views of objects, expected at most 65536"});
}

TEST(ForestTrainer, DataThatCannotTeachIsRefused) {
  std::vector<TrainingView> views = toy::training_views();
  std::vector<TrainingView> no_background(views.begin(), views.begin() + 24);
  EXPECT_THROW(train_forest(no_background, toy::quick_profile(), kQuiet), InputError);
  std::vector<TrainingView> no_object(views.begin() + 24, views.end());
  EXPECT_THROW(train_forest(no_object, toy::quick_profile(), kQuiet), InputError);
  views[3].mask.setTo(0);
  EXPECT_THROW(train_forest(views, toy::quick_profile(), kQuiet), InputError);
}

TEST(ForestTrainer, AnObjectWithoutDepthIsRefused) {
  std::vector<TrainingView> views = toy::training_views();
  for (TrainingView& view : views) view.frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_THROW(train_forest(views, toy::quick_profile(), kQuiet), InputError);
}

/// Returns views of one class, under the number that a folder of its own would give it, and the background images.
std::vector<TrainingView> only(const std::string& name) {
  std::vector<TrainingView> selected;
  for (TrainingView& view : toy::training_views()) {
    if (view.class_id != 0 && view.class_name != name) continue;
    if (view.class_id != 0) view.class_id = 1;
    selected.push_back(std::move(view));
  }
  return selected;
}

Forest stripes_then_rings(int threads) {
  Profile profile = toy::quick_profile();
  profile.training.threads = threads;
  const Forest stripes = train_forest(only("stripes"), profile, kQuiet);
  return add_objects(stripes, only("rings"), profile, kQuiet);
}

TEST(AddObjects, BothTheOldAndTheNewObjectAreFound) {
  const Detector detector(stripes_then_rings(2), DetectionSettings{});
  ASSERT_EQ(detector.groups().front().classes.size(), 2U);
  EXPECT_EQ(detector.groups().front().classes[1].class_id, 2);
  for (const int kind : {0, 1}) {
    RgbdFrame frame = toy::background(77);
    const cv::Mat mask = toy::put_tile(kind, 150, 110, 0.7, frame);
    const Detections found = detector.detect(frame);
    ASSERT_FALSE(found.detections.empty()) << kind;
    EXPECT_EQ(found.detections[0].class_name, kind == 0 ? "stripes" : "rings");
    EXPECT_GT(box_iou(found.detections[0].box_px, cv::Rect2f(cv::boundingRect(mask))), 0.5F);
  }
}

TEST(AddObjects, AnyNumberOfThreadsGivesTheSameFileAndItLoads) {
  const std::string name = "houghstream_add_objects_test";
  const Forest forest = stripes_then_rings(1);
  EXPECT_TRUE(file_bytes(forest, name) == file_bytes(stripes_then_rings(3), name));
  const auto file = std::filesystem::temp_directory_path() / (name + "_load");
  save_forest(forest, file);
  EXPECT_EQ(load_forest(file).views.size(), forest.views.size());
  std::filesystem::remove(file);
}

TEST(AddObjects, AnObjectThatIsKnownIsRefused) {
  const Forest stripes = train_forest(only("stripes"), toy::quick_profile(), kQuiet);
  EXPECT_THROW(add_objects(stripes, only("stripes"), toy::quick_profile(), kQuiet), InputError);
}

}  // namespace
}  // namespace houghstream::training
