#include "tools/evaluate/import/import_scene.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/evaluate/import/mat_writing.hpp"

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

TEST(ImportScene, ImagesThatAreThereAreNotMixedWithOthers) {
  const fs::path scene_folder = fresh_folder("import_mixed_out");
  const fs::path source = write_source("import_mixed");
  fs::create_directories(scene_folder / "rgb");
  write_text(scene_folder / "rgb/000007.png", "recorded");
  EXPECT_EQ(error_of([&] { import_boxes(source, scene_folder); }),
            scene_folder.string() + ": holds pictures already, expected a new folder or one without");
  EXPECT_FALSE(fs::exists(scene_folder / "depth"));
  EXPECT_THROW(import_boxes(source, source / "scene"), InputError);
}

/// Writes desk/desk_1/ with frames 1 and 2, and its annotations: two boxes in the first one.
fs::path write_video(const std::string& name) {
  fs::path video = fresh_folder(name) / "desk" / "desk_1";
  fs::create_directories(video);
  for (const int number : {1, 2}) {
    const std::string stem = (video / ("desk_1_" + std::to_string(number))).string();
    write_png(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(number)), stem + ".png");
    write_png(cv::Mat(48, 64, CV_16UC1, cv::Scalar(700)), stem + "_depth.png");
  }
  const std::vector<MatBox> boxes = {uw_box("soda_can", 4, {6, 25, 11, 30}), uw_box("cap", 1, {6, 40, 41, 50})};
  write_mat(video.parent_path() / "desk_1.mat", mat_cells("bboxes", {mat_boxes(boxes), mat_boxes({})}));
  return video;
}

const Camera kUwCamera{64, 48, 60.0, 61.0, 31.5, 23.5};

TEST(ImportScene, UwVideosBecomeScenesAsBoxesDo) {
  const fs::path video = write_video("import_uw's scene");
  for (const bool is_compressed : {false, true}) {
    if (is_compressed) compress_mat(video.parent_path() / "desk_1.mat");
    const fs::path scene_folder = fresh_folder("import_uw_out");
    EXPECT_EQ(import_uw_scene(is_compressed ? video / "" : video, kUwCamera, scene_folder), 2);
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
  }
}

TEST(ImportScene, UwVideosThatAreNotWholeAreNamed) {
  const fs::path video = write_video("import_uw_parts");
  const fs::path mat = video.parent_path() / "desk_1.mat";
  const fs::path scene_folder = fresh_folder("import_uw_other");
  const auto refusal = [&] { return error_of([&] { import_uw_scene(video, kUwCamera, scene_folder); }); };
  EXPECT_THROW(import_uw_scene(video, {32, 48, 60.0, 61.0, 31.5, 23.5}, scene_folder), InputError);
  EXPECT_THROW(import_uw_scene(video, Camera(), scene_folder), InputError);
  fs::copy_file(video / "desk_1_1.png", video / "desk_1_3.png");
  fs::copy_file(video / "desk_1_1_depth.png", video / "desk_1_3_depth.png");
  EXPECT_EQ(refusal(), mat.string() + " 'bboxes': 2 cells for 3 frames in " + video.string() + ", expected one each");
  fs::remove(video / "desk_1_3_depth.png");
  fs::remove(video / "desk_1_2_depth.png");
  EXPECT_EQ(refusal(),
            (video / "desk_1_2_depth.png").string() + ": missing, expected as frame 2 of the annotated video");
  fs::resize_file(mat, fs::file_size(mat) - 40);
  EXPECT_EQ(refusal(), mat.string() + ": cannot be read (could not read bytes), expected a whole MATLAB file");
  fs::remove(mat);
  EXPECT_EQ(refusal(), mat.string() + ": missing, expected a MATLAB file");
}

// The library that reads such a file dies of an array of numbers that calls itself sparse.
TEST(ImportScene, WhatTheReaderOfMatlabFilesDiesOfIsRefused) {
  const fs::path video = write_video("import_uw_damaged");
  const fs::path mat = video.parent_path() / "desk_1.mat";
  std::string bytes = read_text(mat);
  const std::string array_of_doubles("\6\0\0\0\x08\0\0\0\6", 9);
  bytes[bytes.find(array_of_doubles) + 8] = 5;
  write_text(mat, bytes);
  const std::string line = error_of([&] { import_uw_scene(video, kUwCamera, fresh_folder("import_uw_died")); });
  EXPECT_EQ(line.find(mat.string() + ": its reader ended with status "), 0U) << line;
  EXPECT_NE(line.find(", expected a whole MATLAB file"), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
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
