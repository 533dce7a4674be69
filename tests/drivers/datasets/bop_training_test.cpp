#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
const cv::Rect kOwnBox(150, 100, 30, 20);

RgbdFrame room_frame() {
  RgbdFrame frame = plain_frame(kWidth, kHeight);
  frame.camera = {kWidth, kHeight, 260.0, 260.0, 159.5, 119.5};
  return frame;
}

GroundTruthObject mug() {
  GroundTruthObject object;
  object.object_id = 2;
  object.T_camera_object.translation() = Eigen::Vector3d(0.0, 0.0, 1.0);
  object.box_visible_px = kOwnBox;
  return object;
}

/// Writes one scene with `frames`, the object in each.
fs::path write_training(const std::string& name, const std::vector<RgbdFrame>& frames, bool masks = true) {
  fs::path folder = fresh_folder(name);
  BopWriter writer(folder / "train" / "000002");
  for (const RgbdFrame& frame : frames) {
    std::vector<cv::Mat> visible;
    if (masks) visible.push_back(box_mask(kOwnBox, kWidth, kHeight));
    writer.add(frame, {mug()}, visible);
  }
  writer.finish();
  write_bop_names({{2, "mug"}}, folder / "train" / "000002" / "names.json");
  return folder;
}

RgbdFrame without_object_depth() {
  RgbdFrame frame = room_frame();
  frame.depth(kOwnBox).setTo(std::numeric_limits<float>::quiet_NaN());
  return frame;
}

TEST(BopTraining, ViewsAreCroppedAroundTheObjectAndKeepTheirRays) {
  const auto views = read_bop_training_views(write_training("training", {room_frame()}));
  ASSERT_EQ(views.size(), 1U);
  const TrainingView& view = views[0];
  EXPECT_EQ(view.class_id, 2);
  EXPECT_EQ(view.class_name, "mug");
  EXPECT_EQ(view.T_camera_object.translation().z(), 1.0);
  EXPECT_NO_THROW(check_frame(view.frame, "view"));
  EXPECT_EQ(view.mask.size(), view.frame.colour.size());
  EXPECT_LT(view.frame.camera.width, kWidth);
  EXPECT_EQ(cv::countNonZero(view.mask), kOwnBox.area());
  const cv::Rect box = cv::boundingRect(view.mask);
  const Eigen::Vector3d ray = view.frame.camera.backproject(box.x, box.y, 1.0);
  EXPECT_NEAR((ray - room_frame().camera.backproject(kOwnBox.x, kOwnBox.y, 1.0)).norm(), 0.0, 1e-12);
}

TEST(BopTraining, ImagesWithoutObjectsAreBackground) {
  const fs::path folder = fresh_folder("training_background");
  BopWriter writer(folder);
  writer.add(room_frame(), {}, {});
  writer.finish();
  const auto views = read_bop_training_views(folder);
  ASSERT_EQ(views.size(), 1U);
  EXPECT_EQ(views[0].class_id, 0);
  EXPECT_TRUE(views[0].mask.empty());
  EXPECT_EQ(views[0].frame.colour.cols, kWidth);
}

TEST(BopTraining, ViewsWithoutDepthAreLeftOutAndNothingLeftIsAnError) {
  EXPECT_EQ(read_bop_training_views(write_training("training_hole", {room_frame(), without_object_depth()})).size(),
            1U);
  EXPECT_THROW(read_bop_training_views(write_training("training_holes", {without_object_depth()})), InputError);
}

TEST(BopTraining, EachObjectOfAnImageIsAViewByItsOwnMask) {
  const fs::path folder = fresh_folder("training_crowd");
  const cv::Rect second_box(40, 150, 20, 24);
  GroundTruthObject cup = mug();
  cup.object_id = 5;
  cup.T_camera_object.translation().z() = 2.0;
  BopWriter writer(folder);
  writer.add(
      room_frame(), {mug(), cup, mug()},
      {box_mask(kOwnBox, kWidth, kHeight), box_mask(second_box, kWidth, kHeight), box_mask(kOwnBox, kWidth, kHeight)});
  writer.finish();
  const auto views = read_bop_training_views(folder);
  ASSERT_EQ(views.size(), 3U);
  EXPECT_EQ(views[1].class_id, 5);
  EXPECT_EQ(views[1].class_name, "object_5");
  EXPECT_EQ(views[1].T_camera_object.translation().z(), 2.0);
  EXPECT_EQ(cv::countNonZero(views[1].mask), second_box.area());
  EXPECT_EQ(cv::countNonZero(views[2].mask), kOwnBox.area());
  const cv::Rect box = cv::boundingRect(views[1].mask);
  const Eigen::Vector3d ray = views[1].frame.camera.backproject(box.x, box.y, 1.0);
  EXPECT_NEAR((ray - room_frame().camera.backproject(second_box.x, second_box.y, 1.0)).norm(), 0.0, 1e-12);
}

TEST(BopTraining, WhatIsMostlyHiddenIsLeftOutOfACrowd) {
  const fs::path folder = fresh_folder("training_hidden");
  GroundTruthObject hidden = mug();
  hidden.object_id = 7;
  hidden.visible_fraction = kMinTrainingVisibility - 0.01;
  BopWriter writer(folder);
  const cv::Mat mask = box_mask(kOwnBox, kWidth, kHeight);
  writer.add(room_frame(), {hidden, mug()}, {mask, mask});
  writer.add(room_frame(), {hidden}, {mask});
  writer.finish();
  const auto views = read_bop_training_views(folder);
  ASSERT_EQ(views.size(), 1U) << "an image whose objects are all hidden is no background either";
  EXPECT_EQ(views[0].class_id, 2);
}

TEST(BopTraining, BadFoldersAreRefused) {
  EXPECT_THROW(read_bop_training_views("/no/such/folder"), InputError);
  EXPECT_THROW(read_bop_training_views(fresh_folder("training_empty")), InputError);
  EXPECT_THROW(read_bop_training_views(write_training("training_no_masks", {room_frame()}, false)), InputError);
  const fs::path crowded = fresh_folder("training_crowded");
  BopWriter writer(crowded);
  writer.add(room_frame(), {mug(), mug()}, {});
  writer.finish();
  EXPECT_THROW(read_bop_training_views(crowded), InputError) << "two objects, no masks";
}

}  // namespace
}  // namespace houghstream
