#include "tools/train/uw_dataset.hpp"

#include <gtest/gtest.h>

#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const Camera kUwCamera{640, 480, 525.0, 525.0, 319.5, 239.5};

void write_view(const fs::path& folder, const std::string& instance, int number, int depth_mm = 600) {
  const std::string prefix = (folder / (instance + "_1_" + std::to_string(number))).string();
  write_png(cv::Mat(30, 20, CV_8UC3, cv::Scalar(1, 2, 3)), prefix + "_crop.png");
  write_png(cv::Mat(30, 20, CV_16UC1, cv::Scalar(depth_mm)), prefix + "_depthcrop.png");
  write_png(box_mask({5, 5, 5, 10}, 20, 30), prefix + "_maskcrop.png");
  write_text(prefix + "_loc.txt", "300, 200");
}

/// Writes can_1 and can_2 with four views each, and cup_1 with four.
fs::path write_objects(const std::string& name) {
  fs::path folder = fresh_folder(name);
  for (const std::string instance : {"can_1", "can_2", "cup_1"}) {
    const fs::path inside = folder / instance.substr(0, 3) / instance;
    fs::create_directories(inside);
    for (int number = 1; number <= 4; ++number) write_view(inside, instance, number);
  }
  return folder;
}

TEST(UwDataset, ViewsAreCropsThatKeepTheirRays) {
  const auto views = read_uw_training_views(write_objects("uw"), {}, kUwCamera);
  ASSERT_EQ(views.size(), 12U);
  const TrainingView& view = views.front();
  EXPECT_EQ(view.class_name, "can_1");
  EXPECT_EQ(view.class_id, 1);
  EXPECT_EQ(view.object_frame, "can_1_1");
  EXPECT_EQ(views.back().class_name, "cup_1");
  EXPECT_EQ(views.back().class_id, 3);
  EXPECT_EQ(cv::countNonZero(view.mask), 50);
  EXPECT_FLOAT_EQ(view.frame.depth.at<float>(3, 3), 0.6F);
  const Eigen::Vector3d ray = view.frame.camera.backproject(2, 3, 1.0);
  EXPECT_NEAR((ray - kUwCamera.backproject(302, 203, 1.0)).norm(), 0.0, 1e-12);
}

TEST(UwDataset, YawIsSpreadOverOneTurnAroundAFixedOrigin) {
  const auto views = read_uw_training_views(write_objects("uw_yaw"), {{"cup_1"}, false}, kUwCamera);
  ASSERT_EQ(views.size(), 4U);
  const Eigen::Matrix3d quarter =
      (views[0].T_camera_object.linear().transpose() * views[1].T_camera_object.linear()).eval();
  EXPECT_NEAR(std::abs(Eigen::AngleAxisd(quarter).angle()), M_PI / 2, 1e-9);
  EXPECT_NEAR(std::abs(quarter(2, 2)), 1.0, 1e-9) << "about the object's z axis";
  EXPECT_EQ(views[0].T_camera_object.translation(), views[2].T_camera_object.translation());
}

TEST(UwDataset, InstancesCanTeachOneClass) {
  const fs::path folder = write_objects("uw_classes");
  const auto by_category = read_uw_training_views(folder, {{}, true}, kUwCamera);
  EXPECT_EQ(by_category.front().class_name, "can");
  EXPECT_EQ(by_category.back().class_id, 2);
  const auto renamed = read_uw_training_views(folder, {{"cup_1", "can_1=tin", "can_2=tin"}, false}, kUwCamera);
  EXPECT_EQ(renamed.front().class_name, "cup_1");
  EXPECT_EQ(renamed.front().class_id, 1);
  EXPECT_EQ(renamed.back().class_name, "tin");
  EXPECT_EQ(renamed.back().class_id, 2);
}

TEST(UwDataset, ViewsWithoutDepthAreLeftOutAndNothingLeftIsAnError) {
  const fs::path folder = write_objects("uw_holes");
  write_view(folder / "cup/cup_1", "cup_1", 2, 0);
  EXPECT_EQ(read_uw_training_views(folder, {}, kUwCamera).size(), 11U);
  write_png(cv::Mat(30, 20, CV_8UC1, cv::Scalar(0)), folder / "cup/cup_1/cup_1_1_3_maskcrop.png");
  EXPECT_EQ(read_uw_training_views(folder, {}, kUwCamera).size(), 10U) << "an empty mask";
  for (const int number : {1, 4}) write_view(folder / "cup/cup_1", "cup_1", number, 0);
  EXPECT_THROW(read_uw_training_views(folder, {}, kUwCamera), InputError);
}

TEST(UwDataset, MissingAndDisagreeingFilesAreRefused) {
  const std::string prefix = "cup/cup_1/cup_1_1_3";
  for (const std::string end : {"_depthcrop.png", "_maskcrop.png", "_loc.txt"}) {
    const fs::path folder = write_objects("uw_missing");
    fs::remove(folder / (prefix + end));
    EXPECT_THROW(read_uw_training_views(folder, {}, kUwCamera), InputError) << end;
    write_text(folder / (prefix + end), "nonsense");
    EXPECT_THROW(read_uw_training_views(folder, {}, kUwCamera), InputError) << end;
  }
  const fs::path sizes = write_objects("uw_sizes");
  write_png(box_mask({0, 0, 5, 5}), sizes / (prefix + "_maskcrop.png"));
  EXPECT_THROW(read_uw_training_views(sizes, {}, kUwCamera), InputError);
  const fs::path outside = write_objects("uw_outside");
  write_text(outside / (prefix + "_loc.txt"), "635,10");
  EXPECT_THROW(read_uw_training_views(outside, {}, kUwCamera), InputError);
}

TEST(UwDataset, NumbersAsLargeAsCanBeAreRefused) {
  const fs::path folder = write_objects("uw_large");
  write_text(folder / "cup/cup_1/cup_1_1_1_loc.txt", "2147483647,200");
  EXPECT_NE(error_of([&] {
              read_uw_training_views(folder, {{"cup_1"}, false}, kUwCamera);
            }).find("expected inside"),
            std::string::npos);
  const fs::path other = write_objects("uw_large_names");
  write_text(other / "cup/cup_1/cup_1_2147483647_-2147483648_crop.png", "no view");
  EXPECT_EQ(read_uw_training_views(other, {{"cup_1"}, false}, kUwCamera).size(), 4U);
}

TEST(UwDataset, BadSelectionsAreRefused) {
  const fs::path folder = write_objects("uw_selection");
  EXPECT_THROW(read_uw_training_views(folder, {{"dog_1"}, false}, kUwCamera), InputError);
  EXPECT_THROW(read_uw_training_views(folder, {{"can_1="}, false}, kUwCamera), InputError);
  EXPECT_THROW(read_uw_training_views("/no/such/folder", {}, kUwCamera), InputError);
  EXPECT_THROW(read_uw_training_views(fresh_folder("uw_empty"), {}, kUwCamera), InputError);
  EXPECT_THROW(read_uw_training_views(folder, {}, Camera()), InputError);
}

TEST(UwDataset, BackgroundIsReadInNaturalOrder) {
  const fs::path folder = fresh_folder("uw_background");
  for (const std::string name : {"bg_10", "bg_9"}) {
    write_png(cv::Mat(480, 640, CV_8UC3, cv::Scalar(0)), folder / (name + "_color.png"));
    write_png(cv::Mat(480, 640, CV_16UC1, cv::Scalar(0)), folder / (name + "_depth.png"));
  }
  const auto views = read_background_views(folder, kUwCamera);
  ASSERT_EQ(views.size(), 2U);
  EXPECT_EQ(views[0].class_id, 0);
  EXPECT_NE(views[0].source.find("bg_9"), std::string::npos);
  EXPECT_THROW(read_background_views(fresh_folder("uw_no_background"), kUwCamera), InputError);
}

TEST(UwDataset, BackgroundVideosLieInFoldersBelow) {
  const fs::path folder = fresh_folder("uw_background_videos");
  for (const std::string video : {"background_10", "background_2"}) {
    fs::create_directories(folder / video);
    for (const std::string number : {"_2", "_10"}) {
      const std::string stem = (folder / video / (video + number)).string();
      write_png(cv::Mat(480, 640, CV_8UC3, cv::Scalar(0)), stem + ".png");
      write_png(cv::Mat(480, 640, CV_16UC1, cv::Scalar(0)), stem + "_depth.png");
    }
  }
  const auto views = read_background_views(folder, kUwCamera);
  ASSERT_EQ(views.size(), 4U);
  EXPECT_NE(views[0].source.find("background_2_2.png"), std::string::npos);
  EXPECT_NE(views[1].source.find("background_2_10.png"), std::string::npos);
  EXPECT_NE(views[3].source.find("background_10_10.png"), std::string::npos);
  EXPECT_LT(views[0].frame.id.utime, views[3].frame.id.utime);
  fs::remove(folder / "background_10" / "background_10_2.png");
  EXPECT_THROW(read_background_views(folder, kUwCamera), InputError);
}

}  // namespace
}  // namespace houghstream
