#include "tools/evaluate/bop_results.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_writer.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const std::string kHeader = "scene_id,im_id,obj_id,score,R,t,time\n";

Eigen::Isometry3d some_pose() {
  Eigen::Isometry3d T(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  T.pretranslate(Eigen::Vector3d(0.125, -0.25, 1.5));
  return T;
}

/// Makes a scene of two images without content.
BopScene scene_in(const fs::path& folder) {
  BopWriter writer(folder);
  writer.add(plain_frame(), {}, {});
  writer.add(plain_frame(), {}, {});
  writer.finish();
  return BopScene(folder);
}

ObjectPose pose_of(const std::string& name) {
  ObjectPose pose;
  pose.class_name = name;
  pose.detection_score = 0.75F;
  pose.T_camera_object = some_pose();
  return pose;
}

std::string refusal(const std::string& text) {
  const fs::path file = fresh_folder("bop_results_bad") / "results.csv";
  write_text(file, text);
  try {
    read_bop_results(file);
  } catch (const InputError& error) {
    const std::string line = error.what();
    return line.substr(line.find("results.csv"));
  }
  return "accepted";
}

BopEstimate estimate_of_score(double score) {
  BopEstimate estimate;
  estimate.scene_id = 48;
  estimate.image_id = 36;
  estimate.object_id = 7;
  estimate.score = score;
  return estimate;
}

TEST(BopResults, AreWrittenAsBopToolkitReadsThem) {
  const fs::path file = fresh_folder("bop_results") / "results.csv";
  BopEstimate estimate = estimate_of_score(0.75);
  estimate.T_camera_object.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  estimate.T_camera_object.translation() << 0.125, -0.25, 1.5;
  estimate.time_s = 0.5;
  write_bop_results({estimate}, file);
  EXPECT_EQ(read_text(file), kHeader + "48,36,7,0.75,0 -1 0 1 0 0 0 0 1,125 -250 1500,0.5\n");
  EXPECT_THROW(write_bop_results({}, file / "no_folder.csv"), InputError);
}

TEST(BopResults, WhatIsWrittenIsReadBack) {
  const fs::path file = fresh_folder("bop_results") / "results.csv";
  BopEstimate estimate = estimate_of_score(0.7531);
  estimate.T_camera_object = some_pose() * Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized());
  write_bop_results({estimate, BopEstimate{}}, file);
  const std::vector<BopEstimate> read = read_bop_results(file);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].scene_id, 48);
  EXPECT_EQ(read[0].image_id, 36);
  EXPECT_EQ(read[0].object_id, 7);
  EXPECT_EQ(read[0].score, 0.7531);
  EXPECT_TRUE(read[0].T_camera_object.isApprox(estimate.T_camera_object, 1e-12));
  EXPECT_EQ(read[1].time_s, -1.0);
}

TEST(BopResults, BadFilesAreRefusedWithOneLine) {
  EXPECT_THROW(read_bop_results("/no/such/file.csv"), InputError);
  EXPECT_EQ(refusal("scene,image\n"),
            "results.csv: begins with 'scene,image', expected '" + kHeader.substr(0, kHeader.size() - 1) + "'");
  const std::string good = "1,2,3,0.5,1 0 0 0 1 0 0 0 1,0 0 900,0.1\n";
  EXPECT_EQ(refusal(kHeader + good), "accepted");
  EXPECT_EQ(refusal(kHeader + good + "1,2,3\n"), "results.csv line 3: 3 fields, expected 7");
  EXPECT_EQ(refusal(kHeader + "1,2,x,0.5,1 0 0 0 1 0 0 0 1,0 0 900,0.1\n"),
            "results.csv line 2: 'x', expected an id from 0 on");
  EXPECT_EQ(refusal(kHeader + "1,2,3,nan,1 0 0 0 1 0 0 0 1,0 0 900,0.1\n"),
            "results.csv line 2: 'nan', expected a number");
  EXPECT_EQ(refusal(kHeader + "1,2,3,0.5,1 0 0 0 1 0 0 0 1,0 900,0.1\n"),
            "results.csv line 2: '0 900', expected 3 numbers");
  EXPECT_EQ(refusal(kHeader + "1,2,3,0.5,1 0 0 0 1 0 0 0 -1,0 0 900,0.1\n"),
            "results.csv line 2: R is 1 0 0 0 1 0 0 0 -1, expected a rotation");
}

TEST(GroundTruth, HasTheStampsOfTheRateAtWhichItWasSent) {
  const BopScene scene = scene_in(fresh_folder("ground_truth_rate") / "000001");
  std::vector<EvaluatedFrame> frames = read_ground_truth(scene, {});
  const std::int64_t first = frames[0].utime;
  const std::int64_t second = frames[1].utime;
  stamp_at_rate(30.0, frames);
  EXPECT_EQ(frames[1].utime, second) << "datasets are stamped so";
  stamp_at_rate(15.0, frames);
  EXPECT_EQ(frames[0].utime, first);
  EXPECT_EQ(frames[1].utime, first + 66667);
}

TEST(BopEstimates, CarryTheIdsOfTheScene) {
  const BopScene scene = scene_in(fresh_folder("bop_estimates") / "000048");
  std::vector<EvaluatedFrame> frames = read_ground_truth(scene, {});
  ObjectPose refused = pose_of("mug");
  refused.T_camera_object.reset();
  frames[1].poses = ObjectPoses{{"", frames[1].utime},
                                {refused, pose_of("mug"), pose_of("stranger")},
                                {{"detect.leaves", 200000}, {"pose", 50000}}};
  const std::vector<BopEstimate> estimates = bop_estimates(frames, {{3, "mug"}});
  ASSERT_EQ(estimates.size(), 1U) << "no pose, and no id";
  EXPECT_EQ(estimates[0].scene_id, 48);
  EXPECT_EQ(estimates[0].image_id, 1);
  EXPECT_EQ(estimates[0].object_id, 3);
  EXPECT_EQ(estimates[0].score, 0.75);
  EXPECT_NEAR(estimates[0].time_s, 0.25, 1e-12);
}

TEST(BopEstimates, AnotherNameOfTheFolderIsSceneZeroAndNoStagesNoTime) {
  const BopScene scene = scene_in(fresh_folder("bop_estimates") / "12_monkeys");
  std::vector<EvaluatedFrame> frames = read_ground_truth(scene, {});
  frames[0].poses = ObjectPoses{{"", frames[0].utime}, {pose_of("object_9")}, {}};
  NamedObject object;
  object.class_name = "object_9";
  object.truth.object_id = 9;
  frames[1].objects = {object};
  const std::vector<BopEstimate> estimates = bop_estimates(frames, {});
  ASSERT_EQ(estimates.size(), 1U);
  EXPECT_EQ(estimates[0].scene_id, 0);
  EXPECT_EQ(estimates[0].object_id, 9) << "as the truth has it";
  EXPECT_EQ(estimates[0].time_s, -1.0);
}

}  // namespace
}  // namespace houghstream
