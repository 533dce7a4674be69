#include "detector/training/object_removal.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "detector/detector.hpp"
#include "detector/forest/forest_file.hpp"
#include "detector/training/forest_trainer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream::training {
namespace {

const auto kUnheard = [](const std::string&) {};

const Forest& both() {
  static const Forest forest = train_forest(toy::training_views(), toy::quick_profile(), kUnheard);
  return forest;
}

/// Returns the weight of a class in the leaves, mean over the trees.
double share_of(const Forest& forest, std::size_t class_index) {
  double sum = 0.0;
  for (std::size_t l = 0; l + 1 < forest.leaves.size(); ++l) {
    for (std::uint32_t e = forest.leaves[l]; e < forest.leaves[l + 1]; ++e) {
      if (forest.leaf_classes[e].class_index == class_index)
        sum += static_cast<double>(forest.leaf_weights[l] * forest.leaf_classes[e].probability);
    }
  }
  return sum / static_cast<double>(forest.roots.size());
}

Detections detect(const Forest& forest, int kind) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(kind, 150, 110, 0.7, frame);
  return Detector(forest, DetectionSettings{}).detect(frame);
}

TEST(RemoveObject, TheOtherIsFoundAsBeforeAndTheRemovedNoMore) {
  for (const int kept : {0, 1}) {
    const Forest forest = remove_object(both(), both().classes[static_cast<std::size_t>(1 - kept)].name);
    ASSERT_EQ(forest.classes.size(), 1U);
    const ObjectClass& known = both().classes[static_cast<std::size_t>(kept)];
    EXPECT_EQ(forest.classes[0].name, known.name);
    EXPECT_EQ(forest.classes[0].class_id, known.class_id) << "ids stay";
    const Detections before = detect(both(), kept);
    const Detections after = detect(forest, kept);
    ASSERT_FALSE(after.detections.empty());
    EXPECT_EQ(after.detections[0].class_name, known.name);
    EXPECT_GT(box_iou(after.detections[0].box_px, before.detections.at(0).box_px), 0.8F);
    for (const Detection& found : detect(forest, 1 - kept).detections) EXPECT_EQ(found.class_name, known.name);
  }
}

TEST(RemoveObject, WhatRemainsWeighsAsIfItHadBeenTaughtAlone) {
  const Forest forest = remove_object(both(), "stripes");
  double weights = 0.0;
  for (const float weight : forest.leaf_weights) weights += static_cast<double>(weight);
  EXPECT_NEAR(weights, static_cast<double>(forest.roots.size()), 0.01) << "a tree's sum to 1";
  EXPECT_NEAR(share_of(both(), 1), 0.25, 0.01) << "two objects, and the background as much as both";
  EXPECT_NEAR(share_of(forest, 0), 0.5, 0.01) << "one object, and the background as much";
}

TEST(RemoveObject, NothingOfItIsLeftAndTheFileLoads) {
  const Forest forest = remove_object(both(), "stripes");
  EXPECT_LT(forest.votes.size(), both().votes.size());
  EXPECT_EQ(forest.nodes.size(), both().nodes.size());
  for (const ViewTemplate& view : forest.views) EXPECT_EQ(view.class_index, 0U);
  const auto file = std::filesystem::temp_directory_path() / "houghstream_object_removal_test";
  save_forest(forest, file);
  EXPECT_EQ(load_forest(file).views.size(), forest.views.size());
  std::filesystem::remove(file);
}

TEST(RemoveObject, AnUnknownAndTheOnlyOneAreRefused) {
  EXPECT_THROW(remove_object(both(), "dots"), InputError);
  EXPECT_THROW(remove_object(remove_object(both(), "stripes"), "rings"), InputError);
}

}  // namespace
}  // namespace houghstream::training
