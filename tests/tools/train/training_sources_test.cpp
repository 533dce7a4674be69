#include "tools/train/training_sources.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_writer.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const std::string kCamera = "640x480,525,525,319.5,239.5";

/// Writes turntable views of can_1, can_2 and cup_1, and one background.
std::string write_data() {
  const fs::path folder = fresh_folder("training_sources");
  for (const std::string& instance : std::vector<std::string>{"can_1", "can_2", "cup_1"}) {
    const fs::path inside = folder / "uw" / instance.substr(0, 3) / instance;
    fs::create_directories(inside);
    for (int number = 1; number <= 4; ++number) {
      const std::string prefix = (inside / (instance + "_1_" + std::to_string(number))).string();
      write_png(cv::Mat(30, 20, CV_8UC3, cv::Scalar(1, 2, 3)), prefix + "_crop.png");
      write_png(cv::Mat(30, 20, CV_16UC1, cv::Scalar(600)), prefix + "_depthcrop.png");
      write_png(box_mask({5, 5, 5, 10}, 20, 30), prefix + "_maskcrop.png");
      write_text(prefix + "_loc.txt", "300, 200");
    }
  }
  fs::create_directories(folder / "rooms");
  write_png(cv::Mat(480, 640, CV_8UC3, cv::Scalar(1, 2, 3)), (folder / "rooms" / "a_1.png").string());
  write_png(cv::Mat(480, 640, CV_16UC1, cv::Scalar(1500)), (folder / "rooms" / "a_1_depth.png").string());
  return folder.string();
}

TrainingSources good_sources() {
  static const std::string folder = write_data();
  TrainingSources sources;
  sources.views = {"uw:" + folder + "/uw"};
  sources.backgrounds = {"images:" + folder + "/rooms"};
  sources.camera = kCamera;
  return sources;
}

/// Returns the message of the refusal; empty where nothing is refused.
std::string refusal(const TrainingSources& sources) {
  return error_of([&] { read_training_sources(sources); });
}

TEST(TrainingSources, InstancesOfOneNameBecomeOneClassNumberedByName) {
  TrainingSources sources = good_sources();
  sources.renames = {"can_1=tin", "can_2=tin"};
  const std::vector<TrainingView> views = read_training_sources(sources);
  ASSERT_EQ(views.size(), 13U);
  int tins = 0;
  for (const TrainingView& view : views) {
    const bool is_tin = view.class_name == "tin";
    tins += is_tin ? 1 : 0;
    const int expected_id = is_tin ? 2 : 1;
    EXPECT_EQ(view.class_id, view.class_name.empty() ? 0 : expected_id) << view.class_name;
  }
  EXPECT_EQ(tins, 8);
}

TEST(TrainingSources, UnknownKindsAreNamed) {
  for (const std::string& bad : std::vector<std::string>{"zip:/tmp/x", "images:/tmp/x", "/tmp/x", "uw:", ""}) {
    TrainingSources sources = good_sources();
    sources.views = {bad};
    EXPECT_NE(refusal(sources).find("'" + bad + "': no such training source"), std::string::npos) << refusal(sources);
  }
  for (const std::string& bad : std::vector<std::string>{"uw:/tmp/x", "room"}) {
    TrainingSources sources = good_sources();
    sources.backgrounds = {bad};
    EXPECT_NE(refusal(sources).find("'" + bad + "'"), std::string::npos) << refusal(sources);
  }
}

TEST(TrainingSources, ALayoutWithoutCameraNeedsOne) {
  TrainingSources sources = good_sources();
  sources.camera.reset();
  EXPECT_NE(refusal(sources).find(sources.views[0]), std::string::npos) << refusal(sources);
  EXPECT_NE(refusal(sources).find("expected --camera"), std::string::npos) << refusal(sources);
  sources.camera = "640x480,wide";
  EXPECT_NE(refusal(sources).find("'640x480,wide'"), std::string::npos) << refusal(sources);
}

TEST(TrainingSources, RenamesNeedAnOldAndANewName) {
  for (const std::string& bad : std::vector<std::string>{"can_1", "=can", "can_1="}) {
    TrainingSources sources = good_sources();
    sources.renames = {bad};
    EXPECT_NE(refusal(sources).find("--rename '" + bad + "'"), std::string::npos) << refusal(sources);
  }
}

TEST(TrainingSources, ARenameWithoutEffectIsRefused) {
  TrainingSources sources = good_sources();
  sources.renames = {"can_1=tin", "can_9=tin"};
  EXPECT_EQ(refusal(sources), "--rename 'can_9=tin': no instance 'can_9' is read, but can_1, can_2, cup_1");
  sources.instances = {"can_2", "cup_1"};
  sources.renames = {"can_1=tin"};
  EXPECT_EQ(refusal(sources), "--rename 'can_1=tin': no instance 'can_1' is read, but can_2, cup_1");
  sources.renames = {"can_2=tin", "can_2=box"};
  EXPECT_NE(refusal(sources).find("has another new name already"), std::string::npos) << refusal(sources);
}

TEST(TrainingSources, BopObjectsHaveNamesAlready) {
  const fs::path folder = fresh_folder("training_sources_bop");
  BopWriter writer(folder);
  GroundTruthObject object;
  object.object_id = 1;
  object.T_camera_object.translation().z() = 1.0;
  object.box_visible_px = {20, 10, 16, 12};
  writer.add(plain_frame(), {object}, {box_mask(object.box_visible_px)});
  writer.finish();
  TrainingSources sources;
  sources.views = {"bop:" + folder.string()};
  EXPECT_EQ(refusal(sources), "");
  sources.camera = "bogus";
  EXPECT_NE(refusal(sources).find("--camera 'bogus'"), std::string::npos) << "though nobody needs it";
  sources.camera.reset();
  sources.renames = {"object_1=can"};
  EXPECT_NE(refusal(sources).find("--rename goes with --views uw:DIR"), std::string::npos) << refusal(sources);
  sources.renames.clear();
  sources.instances = {"object_1"};
  EXPECT_NE(refusal(sources).find("--instances goes with --views uw:DIR"), std::string::npos) << refusal(sources);
}

TEST(TrainingSources, AMissingFolderIsNamed) {
  TrainingSources sources = good_sources();
  sources.views = {"uw:/no/such/folder"};
  EXPECT_NE(refusal(sources).find("/no/such/folder"), std::string::npos) << refusal(sources);
}

}  // namespace
}  // namespace houghstream
