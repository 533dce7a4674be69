#include "tools/log/export_results.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/types/frame_results.hpp"
#include "tests/test_files.hpp"
#include "tests/tools/log/recordings.hpp"

namespace houghstream::log_tools {
namespace {

namespace fs = std::filesystem;

Detections make_detections(std::int64_t utime, int count, const std::string& camera = "OPENNI_FRAME") {
  Detections found;
  found.frame = {camera, utime};
  for (int i = 0; i < count; ++i) {
    Detection d;
    d.class_id = i + 1;
    d.class_name = i == 0 ? "bowl" : "a \"can\", red";
    d.score = 0.5F;
    d.box_px = {1.0F, 2.0F, 30.0F, 40.0F};
    d.centre_camera = {0.25F, 0.5F, 1.0F};
    if (i > 0) d.centre_camera.setConstant(std::numeric_limits<float>::quiet_NaN());
    found.detections.push_back(d);
  }
  found.stages = {{"detect.leaves", 1000}};
  return found;
}

ObjectPoses make_poses(std::int64_t utime, const std::string& camera = "OPENNI_FRAME") {
  ObjectPoses poses;
  poses.frame = {camera, utime};
  ObjectPose pose;
  pose.class_id = 1;
  pose.class_name = "bowl";
  pose.detection_index = 0;
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0.5, 0.25, 2.0));
  pose.quality = 0.875F;
  poses.poses.push_back(pose);
  poses.stages = {{"detect.leaves", 1000}, {"pose.refinement", 500}};
  return poses;
}

/// Frame 10 with a bowl that has a pose and a can that has none, frame 20 with nothing.
fs::path write_results(const std::string& name) {
  fs::path file = fresh_folder(name) / "results.lcmlog";
  TestLog log(file);
  log.add(channel::kDetections, to_message(make_detections(10, 2)));
  log.add(channel::kPoses, to_message(make_poses(10)));
  log.add(channel::kDetections, to_message(make_detections(20, 0)));
  log.add_bytes(channel::kDetections, {1, 2, 3});
  log.close();
  return file;
}

TEST(ExportResults, CsvHasARowForEachDetection) {
  const fs::path log = write_results("results_csv");
  LossReport losses;
  EXPECT_EQ(export_results_csv(log, log.parent_path() / "a.csv", losses), 2);
  EXPECT_EQ(losses.refused(), 1);
  std::istringstream lines(read_text(log.parent_path() / "a.csv"));
  std::string header;
  std::string bowl;
  std::string can;
  std::string end;
  std::getline(lines, header);
  std::getline(lines, bowl);
  std::getline(lines, can);
  EXPECT_EQ(bowl, "10,OPENNI_FRAME,0,1,bowl,0.5,1,2,30,40,0.25,0.5,1," + std::string(to_string(PoseStatus::kValid)) +
                      ",0.5,0.25,2,1,0,0,0,0.875");
  EXPECT_EQ(can, "10,OPENNI_FRAME,1,2,\"a \"\"can\"\", red\",0.5,1,2,30,40,,,,not looked for,,,,,,,,");
  EXPECT_FALSE(std::getline(lines, end));
  EXPECT_EQ(std::count(bowl.begin(), bowl.end(), ','), std::count(header.begin(), header.end(), ','));
  EXPECT_EQ(std::count(can.begin(), can.end(), ','), std::count(header.begin(), header.end(), ',') + 1);
}

TEST(ExportResults, JsonHasEmptyFramesToo) {
  const fs::path log = write_results("results_json");
  LossReport losses;
  EXPECT_EQ(export_results_json(log, log.parent_path() / "a.json", losses), 2);
  const nlohmann::json frames = read_json_object(log.parent_path() / "a.json").at("frames");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0]["utime"], 10);
  EXPECT_EQ(frames[0]["detections"][0]["pose"]["trans"], (nlohmann::json{0.5, 0.25, 2.0}));
  EXPECT_TRUE(frames[0]["detections"][1]["pose"].is_null());
  EXPECT_TRUE(frames[0]["detections"][1]["centre"][2].is_null());
  EXPECT_EQ(frames[0]["stages_us"]["pose.refinement"], 500);
  EXPECT_TRUE(frames[1]["detections"].empty());
}

ObjectPoses make_followed(std::int64_t utime) {
  ObjectPoses followed = make_poses(utime);
  followed.poses[0].detection_index = -1;
  followed.poses[0].detection_score = 0.75F;
  ObjectPose can = followed.poses[0];
  can.class_id = 2;
  can.class_name = "can";
  can.status = PoseStatus::kOccluded;
  can.T_camera_object.reset();
  followed.poses.push_back(can);
  followed.stages = {{kFollowingStage, 700}};
  return followed;
}

TEST(ExportResults, WhatIsFollowedIsWrittenWithoutDetections) {
  const fs::path file = fresh_folder("results_followed") / "results.lcmlog";
  TestLog log(file);
  log.add(channel::kPoses, to_message(make_followed(10)));
  log.close();
  LossReport losses;
  EXPECT_EQ(export_results_csv(file, file.parent_path() / "a.csv", losses), 1);
  EXPECT_EQ(losses.line(), "");
  const std::string csv = read_text(file.parent_path() / "a.csv");
  EXPECT_NE(csv.find("\n10,OPENNI_FRAME,-1,1,bowl,0.75,,,,,,,," + std::string(to_string(PoseStatus::kValid)) +
                     ",0.5,0.25,2,1,0,0,0,0.875\n"),
            std::string::npos)
      << csv;
  EXPECT_EQ(export_results_json(file, file.parent_path() / "a.json", losses), 1);
  const nlohmann::json frame = read_json_object(file.parent_path() / "a.json").at("frames")[0];
  ASSERT_EQ(frame["detections"].size(), 2U);
  EXPECT_TRUE(frame["detections"][0]["box"].is_null());
  EXPECT_EQ(frame["detections"][0]["pose"]["trans"], (nlohmann::json{0.5, 0.25, 2.0}));
  EXPECT_EQ(frame["detections"][1]["pose"]["status"], to_string(PoseStatus::kOccluded));
  EXPECT_EQ(frame["stages_us"][kFollowingStage], 700);
}

TEST(ExportResults, WhatIsFollowedAndDetectedIsWrittenOnce) {
  for (const bool answered : {true, false}) {
    const fs::path file = fresh_folder("results_both") / "results.lcmlog";
    TestLog log(file);
    log.add(channel::kPoses, to_message(make_followed(10)));
    log.add(channel::kDetections, to_message(make_detections(10, 1)));
    if (answered) log.add(channel::kPoses, to_message(make_poses(10)));
    log.close();
    LossReport losses;
    export_results_json(file, file.parent_path() / "a.json", losses);
    const nlohmann::json found = read_json_object(file.parent_path() / "a.json").at("frames")[0]["detections"];
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0]["class_name"], "bowl");
    EXPECT_EQ(found[0]["box"].is_null(), !answered);
    EXPECT_EQ(found[0]["pose"]["trans"], (nlohmann::json{0.5, 0.25, 2.0}));
    EXPECT_EQ(found[1]["class_name"], "can");
  }
}

TEST(ExportResults, CandidatesThatNoPoseConfirmsAreLeftOut) {
  const fs::path file = fresh_folder("results_candidates") / "results.lcmlog";
  TestLog log(file);
  Detections found = make_detections(10, 2);
  for (Detection& detection : found.detections) detection.reported = false;
  log.add(channel::kDetections, to_message(found));
  log.add(channel::kPoses, to_message(make_poses(10)));
  log.close();
  LossReport losses;
  export_results_csv(file, file.parent_path() / "a.csv", losses);
  const std::string csv = read_text(file.parent_path() / "a.csv");
  EXPECT_NE(csv.find(",bowl,"), std::string::npos) << "it has a pose";
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 2);
  export_results_json(file, file.parent_path() / "a.json", losses);
  EXPECT_EQ(read_json_object(file.parent_path() / "a.json").at("frames")[0]["detections"].size(), 1U);
}

TEST(ExportResults, CamerasOfEqualTimesAndSeveralDetectorsAreAllThere) {
  const fs::path folder = fresh_folder("results_two_cameras");
  TestLog log(folder / "log");
  constexpr int kFrames = 20;
  for (const std::string camera : {"LEFT", "RIGHT"}) {
    for (int i = 0; i < kFrames; ++i) {
      log.add(channel::kDetections, to_message(make_detections(i, 1, camera)));
      Detections cup = make_detections(i, 1, camera);
      cup.detections[0].class_name = "cup";
      cup.detections[0].score = 0.75F;
      log.add(channel::kDetections, to_message(cup));
      ObjectPoses pose = make_poses(i, camera);
      pose.poses[0].T_camera_object->translation().x() = camera == "LEFT" ? 1.0 : 2.0;
      log.add(channel::kPoses, to_message(pose));
    }
  }
  log.close();
  LossReport losses;
  EXPECT_EQ(export_results_json(folder / "log", folder / "a.json", losses), 2 * kFrames);
  EXPECT_EQ(losses.line(), "");
  const nlohmann::json frames = read_json_object(folder / "a.json").at("frames");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool left = i % 2 == 0;
    EXPECT_EQ(frames[i]["utime"], i / 2) << "in the order of time";
    EXPECT_EQ(frames[i]["source_channel"], left ? "LEFT" : "RIGHT");
    ASSERT_EQ(frames[i]["detections"].size(), 2U);
    EXPECT_EQ(frames[i]["detections"][0]["class_name"], "cup") << "strongest first";
    EXPECT_TRUE(frames[i]["detections"][0]["pose"].is_null());
    EXPECT_EQ(frames[i]["detections"][1]["pose"]["trans"][0], left ? 1.0 : 2.0);
    EXPECT_EQ(frames[i]["stages_us"]["pose.refinement"], 500);
  }
  EXPECT_EQ(export_results_csv(folder / "log", folder / "a.csv", losses), 2 * kFrames);
  const std::string rows = read_text(folder / "a.csv");
  EXPECT_EQ(std::count(rows.begin(), rows.end(), '\n'), 1 + 4 * kFrames);
}

TEST(ExportResults, PosesOfNoDetectionsAreCounted) {
  const fs::path folder = fresh_folder("results_stray");
  TestLog log(folder / "log");
  log.add(channel::kDetections, to_message(make_detections(1, 1, "LEFT")));
  log.add(channel::kPoses, to_message(make_poses(1, "RIGHT")));
  log.close();
  LossReport losses;
  EXPECT_EQ(export_results_csv(folder / "log", folder / "a.csv", losses), 1);
  EXPECT_NE(losses.line().find("poses of frame RIGHT 1"), std::string::npos) << losses.line();
}

TEST(ExportResults, ALogWithoutResultsIsRefused) {
  const fs::path folder = fresh_folder("results_none");
  TestLog log(folder / "log");
  log.add("OPENNI_FRAME", foreign_images(numbered_frame(0)));
  log.close();
  LossReport losses;
  EXPECT_THROW(export_results_csv(folder / "log", folder / "a.csv", losses), InputError);
  EXPECT_THROW(export_results_json(write_results("results_where"), folder / "no" / "a.json", losses), InputError);
}

}  // namespace
}  // namespace houghstream::log_tools
