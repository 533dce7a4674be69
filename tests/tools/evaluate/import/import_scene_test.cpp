#include "tools/evaluate/import/import_scene.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/drivers/mat_writing.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const std::string kBoxesFile = R"({"image_size": [64, 48], "camera": {"fx": 60, "fy": 61, "cx": 31.5, "cy": 23.5},
 "frames": [{"frame": "a_10", "objects": [{"object": "pack", "bbox_xyxy": [10, 5, 30, 25]},
                                          {"object": "can", "bbox_xyxy": [40, 5, 50, 40]}]},
            {"frame": "a_9", "objects": []}]})";

fs::path write_source(const std::string& name) {
  fs::path folder = fresh_folder(name);
  for (const int number : {9, 10}) {
    const std::string stem = "a_" + std::to_string(number);
    write_png(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(number)), folder / (stem + "_color.png"));
    write_png(cv::Mat(48, 64, CV_16UC1, cv::Scalar(700)), folder / (stem + "_depth.png"));
  }
  write_text(folder / "boxes.json", kBoxesFile);
  return folder;
}

TEST(ImportScene, BoxesBecomeASceneWithoutPosesInTheirOrder) {
  const fs::path scene_folder = fresh_folder("import_boxes_out");
  EXPECT_EQ(import_boxes(write_source("import_boxes"), scene_folder), 2);
  const BopScene scene(scene_folder);
  ASSERT_EQ(scene.images().size(), 2U);
  EXPECT_EQ(scene.read_frame(0).colour.at<cv::Vec3b>(0, 0)[0], 10);
  EXPECT_EQ(scene.images()[0].camera.fy, 61.0);
  ASSERT_EQ(scene.images()[0].objects.size(), 2U);
  EXPECT_TRUE(scene.images()[1].objects.empty());
  const GroundTruthObject& pack = scene.images()[0].objects[0];
  EXPECT_FALSE(pack.has_pose);
  EXPECT_EQ(pack.box_visible_px, cv::Rect(10, 5, 20, 20));
  EXPECT_EQ(find_bop_names(scene_folder), (std::map<int, std::string>{{1, "can"}, {2, "pack"}}));
  EXPECT_EQ(pack.object_id, 2);
}

TEST(ImportScene, PicturesThatAreThereAreNotMixedWithOthers) {
  const fs::path scene_folder = fresh_folder("import_mixed_out");
  const fs::path source = write_source("import_mixed");
  fs::create_directories(scene_folder / "rgb");
  write_text(scene_folder / "rgb/000007.png", "recorded");
  EXPECT_EQ(error_of([&] { import_boxes(source, scene_folder); }),
            scene_folder.string() + ": holds pictures already, expected a new folder or one without");
  EXPECT_FALSE(fs::exists(scene_folder / "depth"));
  EXPECT_THROW(import_boxes(source, source / "scene"), InputError);
}

TEST(ImportScene, UwVideosBecomeScenesAsBoxesDo) {
  const fs::path video = fresh_folder("import_uw") / "desk" / "desk_1";
  fs::create_directories(video);
  for (const int number : {1, 2}) {
    const std::string stem = (video / ("desk_1_" + std::to_string(number))).string();
    write_png(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(number)), stem + ".png");
    write_png(cv::Mat(48, 64, CV_16UC1, cv::Scalar(700)), stem + "_depth.png");
  }
  const std::vector<MatBox> boxes = {uw_box("soda_can", 4, {6, 25, 11, 30}), uw_box("cap", 1, {6, 40, 41, 50})};
  write_mat(video.parent_path() / "desk_1.mat", mat_cells("bboxes", {mat_boxes(boxes), mat_boxes({})}));
  const fs::path scene_folder = fresh_folder("import_uw_out");
  EXPECT_EQ(import_uw_scene(video, {64, 48, 60.0, 61.0, 31.5, 23.5}, scene_folder), 2);
  const BopScene scene(scene_folder);
  ASSERT_EQ(scene.images().size(), 2U);
  EXPECT_EQ(scene.images()[0].camera.fy, 61.0);
  EXPECT_EQ(scene.read_frame(1).colour.at<cv::Vec3b>(0, 0)[0], 2);
  EXPECT_FLOAT_EQ(scene.read_frame(0).depth.at<float>(0, 0), 0.7F);
  EXPECT_TRUE(scene.images()[1].objects.empty());
  ASSERT_EQ(scene.images()[0].objects.size(), 2U);
  const GroundTruthObject& can = scene.images()[0].objects[0];
  EXPECT_FALSE(can.has_pose);
  EXPECT_EQ(can.object_id, 2);
  EXPECT_EQ(can.box_visible_px, cv::Rect(10, 5, 20, 20));
  EXPECT_EQ(can.visible_fraction, 1.0);
  EXPECT_EQ(find_bop_names(scene_folder), (std::map<int, std::string>{{1, "cap_1"}, {2, "soda_can_4"}}));
  const fs::path other_folder = fresh_folder("import_uw_other");
  EXPECT_THROW(import_uw_scene(video, {32, 48, 60.0, 61.0, 31.5, 23.5}, other_folder), InputError);
  EXPECT_THROW(import_uw_scene(video, Camera(), other_folder), InputError);
}

TEST(ImportScene, BadSourcesAreRefused) {
  EXPECT_THROW(import_boxes(fresh_folder("import_nothing"), fresh_folder("import_bad_out")), InputError);
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"[10, 5, 30, 25]", "[10, 5, 300, 25]"},
                                                        {"[10, 5, 30, 25]", "[30, 5, 10, 25]"},
                                                        {"\"fx\": 60", "\"fx\": 0"},
                                                        {"\"frame\": \"a_9\"", "\"frame\": \"a_8\""},
                                                        {"\"objects\": []", "\"objects\": 0"},
                                                        {"[64, 48]", "[640, 480]"}}) {
    const fs::path source = write_source("import_bad");
    replace_in_file(source / "boxes.json", from, to);
    EXPECT_THROW(import_boxes(source, fresh_folder("import_bad_out")), InputError) << from << " -> " << to;
  }
}

}  // namespace
}  // namespace houghstream
