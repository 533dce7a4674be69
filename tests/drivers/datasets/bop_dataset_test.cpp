#include "drivers/datasets/bop_dataset.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const cv::Rect kBox(20, 10, 16, 12);

GroundTruthObject some_object() {
  GroundTruthObject object;
  object.object_id = 3;
  object.T_camera_object =
      Eigen::Translation3d(0.1, -0.2, 1.5) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  object.box_visible_px = kBox;
  object.visible_fraction = 0.75;
  return object;
}

/// Writes twelve images with one object each: enough for image 10 to come before image 9 in the order of text.
fs::path write_scene(const std::string& name) {
  fs::path folder = fresh_folder(name);
  BopWriter writer(folder);
  for (int i = 0; i < 12; ++i) {
    RgbdFrame frame = plain_frame();
    frame.depth.at<float>(1, 1) = 1.0F + 0.001F * static_cast<float>(i);
    writer.add(frame, {some_object()}, {box_mask(kBox)});
  }
  writer.finish();
  return folder;
}

TEST(BopScene, WhatIsWrittenIsReadBack) {
  const BopScene scene(write_scene("bop_round_trip"));
  ASSERT_EQ(scene.images().size(), 12U);
  EXPECT_EQ(scene.images()[10].image_id, 10);
  const RgbdFrame frame = scene.read_frame(10);
  EXPECT_EQ(frame.camera, plain_frame().camera);
  EXPECT_EQ(frame.colour.at<cv::Vec3b>(5, 5), cv::Vec3b(10, 20, 30));
  EXPECT_NEAR(frame.depth.at<float>(1, 1), 1.010F, 1e-6F);
  EXPECT_TRUE(std::isnan(frame.depth.at<float>(0, 0)));
  EXPECT_EQ(frame.id.utime - scene.read_frame(9).id.utime, 33333);
  ASSERT_EQ(scene.images()[10].objects.size(), 1U);
  const GroundTruthObject& object = scene.images()[10].objects[0];
  EXPECT_EQ(object.object_id, 3);
  EXPECT_TRUE(object.has_pose);
  EXPECT_TRUE(object.T_camera_object.isApprox(some_object().T_camera_object, 1e-9));
  EXPECT_EQ(object.box_visible_px, kBox);
  EXPECT_EQ(object.visible_fraction, 0.75);
  EXPECT_EQ(cv::countNonZero(scene.read_mask(10, 0)), kBox.area());
}

TEST(BopScene, ObjectsMayHaveABoxOnlyOrNoBox) {
  const fs::path folder = fresh_folder("bop_box_only");
  GroundTruthObject box_only = some_object();
  box_only.has_pose = false;
  GroundTruthObject hidden = some_object();
  hidden.box_visible_px = {};
  hidden.visible_fraction = 0.0;
  BopWriter writer(folder);
  writer.add(plain_frame(), {box_only, hidden}, {});
  writer.finish();
  const BopScene scene(folder);
  EXPECT_FALSE(scene.images()[0].objects[0].has_pose);
  EXPECT_EQ(scene.images()[0].objects[0].box_visible_px, kBox);
  EXPECT_TRUE(scene.images()[0].objects[1].has_pose);
  EXPECT_TRUE(scene.images()[0].objects[1].box_visible_px.empty());
  EXPECT_FALSE(fs::exists(folder / "mask_visib"));
}

TEST(BopScene, DepthIsScaledAndSizesComeFromTheImageWhereBopHasNone) {
  const fs::path folder = write_scene("bop_scale");
  fs::remove(folder / "scene_gt.json");  // it lists the other images too
  write_text(folder / "scene_camera.json", R"({"7": {"cam_K": [60,0,31.5, 0,61,23.5, 0,0,1], "depth_scale": 0.1}})");
  fs::rename(folder / "rgb/000000.png", folder / "rgb/000007.png");
  fs::rename(folder / "depth/000000.png", folder / "depth/000007.png");
  const BopScene scene(folder);
  ASSERT_EQ(scene.images().size(), 1U);
  EXPECT_EQ(scene.images()[0].camera, plain_frame().camera);
  EXPECT_NEAR(scene.read_frame(0).depth.at<float>(5, 5), 0.1F, 1e-6F);
  EXPECT_TRUE(std::isnan(scene.read_frame(0).depth.at<float>(0, 0)));
}

TEST(BopScene, WithoutTruthItIsBackground) {
  const fs::path folder = write_scene("bop_background");
  fs::remove(folder / "scene_gt.json");
  EXPECT_TRUE(BopScene(folder).images()[0].objects.empty());
}

/// A scene whose `file` has `from` replaced by `to` is refused, and the message names the file or the folder.
void expect_refused(const std::string& file, const std::string& from, const std::string& to) {
  const fs::path folder = write_scene("bop_absurd");
  replace_in_file(folder / file, from, to);
  try {
    const BopScene scene(folder);
    FAIL() << file << ": " << from << " -> " << to << " was accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(folder.string()), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

TEST(BopScene, AbsurdNumbersAreRefused) {
  expect_refused("scene_camera.json", "\"depth_scale\": 1.0", "\"depth_scale\": 0.0");
  expect_refused("scene_camera.json", "\"depth_scale\": 1.0", "\"depth_scale\": -1");
  expect_refused("scene_camera.json", "\"depth_scale\": 1.0", "\"depth_scale\": \"1\"");
  expect_refused("scene_camera.json", "60.0", "-60.0");
  expect_refused("scene_camera.json", "60.0", "1e999");
  expect_refused("scene_camera.json", "31.5", "3150000");
  expect_refused("scene_camera.json", "\"0\": {", "\"zero\": {");
  expect_refused("scene_camera.json", "\"width\": 64", "\"width\": 64000000");
  expect_refused("scene_gt.json", "\"obj_id\": 3", "\"obj_id\": 0");
  expect_refused("scene_gt.json", "1500.0", "1500000000.0");
  expect_refused("scene_gt.json", "\"cam_t_m2c\"", "\"cam_t\"");
  expect_refused("scene_gt_info.json", "\"visib_fract\": 0.75", "\"visib_fract\": 1.5");
  expect_refused("scene_gt_info.json", "\"visib_fract\": 0.75", "\"visib_fract\": null");
  expect_refused("scene_gt_info.json", "20,", "60,");
  expect_refused("scene_gt_info.json", "\"3\": [", "\"99\": [");
  expect_refused("scene_gt_info.json", "{", "[");
}

// One bit of an image's number is flipped.
TEST(BopScene, ObjectsOfAnImageThatIsNotThereAreRefused) {
  expect_refused("scene_camera.json", "\"11\": {", "\"31\": {");
  expect_refused("scene_camera.json", "\"11\": {", "\"10\": {");
  expect_refused("scene_gt.json", "\"11\": [", "\"10\": [");
}

/// Writes a scene with one object of this "rotation".
fs::path scene_with_rotation(const Eigen::Matrix3d& R) {
  fs::path folder = fresh_folder("bop_rotation");
  GroundTruthObject object = some_object();
  object.T_camera_object.linear() = R;
  BopWriter writer(folder);
  writer.add(plain_frame(), {object}, {});
  writer.finish();
  return folder;
}

Eigen::Matrix3d rounded_to(const Eigen::Matrix3d& R, double step) {
  return (R / step).array().round().matrix() * step;
}

TEST(BopScene, ARotationThatIsOffByLessThanAPerCentBecomesTheNearestOne) {
  const Eigen::Matrix3d R = some_object().T_camera_object.linear();
  const Eigen::Matrix3d sheared = R + 0.004 * Eigen::Vector3d::UnitX() * Eigen::RowVector3d(1.0, 1.0, -1.0);
  for (const Eigen::Matrix3d& published : {Eigen::Matrix3d(0.992 * R), rounded_to(R, 0.01), sheared}) {
    const Eigen::Matrix3d read =
        BopScene(scene_with_rotation(published)).images()[0].objects[0].T_camera_object.linear();
    EXPECT_TRUE((read * read.transpose()).isIdentity(1e-12)) << read;
    EXPECT_GT(read.determinant(), 0.0);
    const double off = (read - published).norm();
    for (int axis = 0; axis < 3; ++axis) {
      for (const double angle : {-1e-3, 1e-3}) {
        const Eigen::Matrix3d other = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)) * read;
        EXPECT_LE(off, (other - published).norm()) << "no rotation is nearer";
      }
    }
  }
}

TEST(BopScene, ARotationIsReadAsItWasWritten) {
  const Eigen::Matrix3d R = some_object().T_camera_object.linear();
  const Eigen::Matrix3d read = BopScene(scene_with_rotation(R)).images()[0].objects[0].T_camera_object.linear();
  EXPECT_LT((read - R).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(BopScene, WhatIsFartherOffARotationIsRefused) {
  const Eigen::Matrix3d R = some_object().T_camera_object.linear();
  Eigen::Matrix3d mirrored = R;
  mirrored.col(2) *= -1.0;
  Eigen::Matrix3d stretched = R;
  stretched.col(0) *= 1.02;
  for (const Eigen::Matrix3d& published : {Eigen::Matrix3d(1.01 * R), mirrored, stretched}) {
    const fs::path folder = scene_with_rotation(published);
    try {
      const BopScene scene(folder);
      FAIL() << published << " was accepted";
    } catch (const InputError& error) {
      const std::string words = error.what();
      EXPECT_NE(words.find((folder / "scene_gt.json").string() + " image 0 object 0: 'cam_R_m2c' is off"),
                std::string::npos)
          << words;
      EXPECT_NE(words.find("expected less than 1 %"), std::string::npos) << words;
    }
  }
}

TEST(BopScene, MissingAndUnreadableFilesAreRefused) {
  EXPECT_THROW(BopScene(fresh_folder("bop_empty")), InputError);
  const fs::path folder = write_scene("bop_files");
  const BopScene scene(folder);
  fs::remove(folder / "rgb/000000.png");
  EXPECT_THROW(scene.read_frame(0), InputError);
  write_text(folder / "rgb/000001.png", "no image");
  EXPECT_THROW(scene.read_frame(1), InputError);
  fs::remove(folder / "depth/000002.png");
  EXPECT_THROW(scene.read_frame(2), InputError);
  fs::copy_file(folder / "rgb/000003.png", folder / "depth/000003.png", fs::copy_options::overwrite_existing);
  EXPECT_THROW(scene.read_frame(3), InputError) << "depth is a colour image";
  write_png(cv::Mat(5, 5, CV_16UC1, cv::Scalar(1)), folder / "depth/000004.png");
  EXPECT_THROW(scene.read_frame(4), InputError) << "sizes disagree";
  fs::remove(folder / "mask_visib/000005_000000.png");
  EXPECT_THROW(scene.read_mask(5, 0), InputError);
  write_png(cv::Mat(5, 5, CV_8UC1, cv::Scalar(1)), folder / "mask_visib/000006_000000.png");
  EXPECT_THROW(scene.read_mask(6, 0), InputError);
}

}  // namespace
}  // namespace houghstream
