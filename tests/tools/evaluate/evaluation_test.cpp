#include "tools/evaluate/evaluation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "pipeline/base/checks.hpp"
#include "pipeline/types/frame_results.hpp"
#include "tools/evaluate/metrics/detection_metrics.hpp"
#include "tools/evaluate/metrics/latency.hpp"
#include "tools/evaluate/metrics/pose_metrics.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const cv::Rect kLeft(0, 0, 100, 100);
const cv::Rect kRight(200, 0, 100, 100);

NamedObject object(const std::string& name, const cv::Rect& box, double visible = 1.0) {
  NamedObject out;
  out.class_name = name;
  out.truth.box_visible_px = box;
  out.truth.visible_fraction = visible;
  return out;
}

Detection detection(const std::string& name, const cv::Rect& box, float score) {
  Detection out;
  out.class_name = name;
  out.box_px = box;
  out.score = score;
  return out;
}

EvaluatedFrame frame(std::vector<NamedObject> objects, std::vector<Detection> detections, std::int64_t utime = 0) {
  EvaluatedFrame out;
  out.utime = utime;
  out.objects = std::move(objects);
  out.detections = Detections{{"", utime}, std::move(detections), {}};
  return out;
}

TEST(DetectionMetrics, AucIsTheSumOfPrecisionsAtTruePositivesOverTheTruth) {
  // The ranking is true, false, true, and one of three mugs is missed: (1/1 + 2/3) / 3 = 5/9.
  const std::vector<EvaluatedFrame> frames = {frame({object("mug", kLeft), object("mug", kRight)},
                                                    {detection("mug", kLeft, 0.9F), detection("mug", kRight, 0.5F)}),
                                              frame({object("mug", kLeft)}, {detection("mug", kRight, 0.7F)})};
  const ClassResult result = evaluate_class(frames, "mug", {});
  EXPECT_EQ(result.required, 3);
  EXPECT_NEAR(result.auc, 5.0 / 9.0, 1e-12);
  ASSERT_EQ(result.curve.size(), 3U);
  EXPECT_NEAR(result.curve[1].precision, 0.5, 1e-12);
  EXPECT_NEAR(result.curve[1].recall, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(result.curve[2].precision, 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(result.curve[2].recall, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(result.curve[2].score, 0.5F);
}

TEST(DetectionMetrics, OverlapOfHalfIsEnoughAndLessIsNot) {
  // Boxes 100 wide shifted by 33 and 34 pixels: 67/133 = 0.504, 66/134 = 0.493.
  EXPECT_NEAR(
      evaluate_class({frame({object("mug", kLeft)}, {detection("mug", kLeft + cv::Point(33, 0), 1)})}, "mug", {}).auc,
      1.0, 1e-12);
  EXPECT_NEAR(
      evaluate_class({frame({object("mug", kLeft)}, {detection("mug", kLeft + cv::Point(34, 0), 1)})}, "mug", {}).auc,
      0.0, 1e-12);
}

TEST(DetectionMetrics, RepeatedDetectionsAreFalse) {
  const ClassResult result = evaluate_class(
      {frame({object("mug", kLeft)}, {detection("mug", kLeft, 0.8F), detection("mug", kLeft, 0.9F)})}, "mug", {});
  ASSERT_EQ(result.judged.size(), 2U);
  EXPECT_EQ(result.judged[0].index, 1U) << "strongest first";
  EXPECT_EQ(result.judged[0].outcome, MatchOutcome::kTruePositive);
  EXPECT_EQ(result.judged[1].outcome, MatchOutcome::kFalsePositive);
  EXPECT_EQ(result.auc, 1.0);
}

TEST(DetectionMetrics, OtherClassesDoNotCount) {
  const std::vector<EvaluatedFrame> frames = {frame({object("mug", kLeft)}, {detection("can", kLeft, 0.9F)})};
  EXPECT_EQ(evaluate_class(frames, "mug", {}).auc, 0.0);
  const ClassResult can = evaluate_class(frames, "can", {});
  EXPECT_TRUE(std::isnan(can.auc));
  EXPECT_EQ(count_reported(can, MatchOutcome::kFalsePositive, 0.0F).all(), 1);
  EXPECT_EQ(count_reported(can, MatchOutcome::kFalsePositive, 0.95F).all(), 0);
  ASSERT_EQ(can.curve.size(), 1U) << "it counts where another scene has cans";
  EXPECT_EQ(can.curve[0].recall, 0.0);
}

TEST(DetectionMetrics, HardlyVisibleObjectsAreNeitherRequiredNorFalse) {
  const std::vector<EvaluatedFrame> frames = {frame({object("mug", kLeft, 0.05), object("mug", kRight)},
                                                    {detection("mug", kLeft, 0.9F), detection("mug", kRight, 0.8F)})};
  const ClassResult result = evaluate_class(frames, "mug", {});
  EXPECT_EQ(result.required, 1);
  EXPECT_EQ(result.judged[0].outcome, MatchOutcome::kIgnored);
  EXPECT_EQ(result.auc, 1.0);
  DetectionRules strict;
  strict.min_visible = 0.0;
  EXPECT_EQ(evaluate_class(frames, "mug", strict).required, 2);
}

TEST(DetectionMetrics, SkippedFramesCountAsMissedUnlessLeftOut) {
  std::vector<EvaluatedFrame> frames = {frame({object("mug", kLeft)}, {detection("mug", kLeft, 1)}),
                                        frame({object("mug", kLeft)}, {})};
  frames[1].detections.reset();
  EXPECT_EQ(evaluate_class(frames, "mug", {}).auc, 0.5);
  EXPECT_EQ(evaluate_class(processed_frames(frames), "mug", {}).auc, 1.0);
}

TEST(DetectionMetrics, OnlyTheStrongestOfAClassInAFrameCount) {
  std::vector<Detection> many(300, detection("mug", kRight, 0.5F));
  many.push_back(detection("mug", kLeft, 0.1F));
  const std::vector<EvaluatedFrame> frames = {frame({object("mug", kLeft)}, many)};
  EXPECT_EQ(evaluate_class(frames, "mug", {}).judged.size(), 250U);
  EXPECT_EQ(evaluate_class(frames, "mug", {}).auc, 0.0);
}

TEST(DetectionMetrics, MeansSkipClassesThatDoNotAppear) {
  ClassResult often;
  often.required = 3;
  often.auc = 1.0;
  ClassResult once;
  once.required = 1;
  once.auc = 0.2;
  ClassResult never;
  never.auc = std::nan("");
  EXPECT_NEAR(mean_auc({often, once, never}), 0.6, 1e-12);
  EXPECT_NEAR(weighted_auc({often, once, never}), 0.8, 1e-12);
  EXPECT_TRUE(std::isnan(mean_auc({never})));
}

TEST(EvaluatedFrames, ResultsFindTheirFrameOrAreRefused) {
  std::vector<EvaluatedFrame> frames(2);
  frames[0].utime = 10;
  frames[1].utime = 20;
  const Detections mug{{"", 20}, {detection("mug", kLeft, 1)}, {}};
  add_results(frames, {{mug}, {}}, "test");
  EXPECT_FALSE(frames[0].detections.has_value());
  EXPECT_TRUE(frames[1].detections.has_value());
  EXPECT_THROW(add_results(frames, {{Detections{{"", 30}, {}, {}}}, {}}, "test"), InputError) << "an unknown frame";
  ObjectPose pose;
  pose.class_name = "mug";
  pose.detection_index = 1;
  EXPECT_THROW(add_results(frames, {{mug}, {{{"", 20}, {pose}, {}}}}, "test"), InputError) << "no such detection";
}

TEST(EvaluatedFrames, PosesThatWereFollowedCountWhereNoDetectorLooked) {
  std::vector<EvaluatedFrame> frames(1);
  ObjectPose pose;
  pose.class_name = "mug";
  pose.detection_index = -1;
  add_results(frames, {{}, {{{"", 0}, {pose}, {{kFollowingStage, 1000}}}}}, "test");
  ASSERT_TRUE(frames[0].poses.has_value());
  EXPECT_EQ(frames[0].poses->poses.size(), 1U);
  EXPECT_FALSE(frames[0].detections.has_value());
}

TEST(EvaluatedFrames, DetectorsOfDifferentObjectsAreJoined) {
  std::vector<EvaluatedFrame> frames(1);
  const Detections mug{{"", 0}, {detection("mug", kLeft, 0.5F)}, {}};
  const Detections bowl{{"", 0}, {detection("bowl", kLeft, 0.75F)}, {}};
  ObjectPose pose;
  pose.class_name = "mug";
  pose.detection_score = 0.5F;
  pose.detection_index = 0;
  add_results(frames, {{mug, bowl}, {{{"", 0}, {pose}, {}}}}, "test");
  ASSERT_EQ(frames[0].detections->detections.size(), 2U);
  EXPECT_EQ(frames[0].detections->detections[0].class_name, "bowl");
  EXPECT_EQ(frames[0].poses->poses.at(0).detection_index, 1);
  Detections another_run = mug;
  another_run.detections[0].score = 0.4F;
  EXPECT_THROW(add_results(frames, {{mug, another_run}, {}}, "test"), InputError) << "it would count twice";
  add_results(frames, {{mug, mug}, {}}, "test");
  EXPECT_EQ(frames[0].detections->detections.size(), 1U) << "the same run, played again";
}

TEST(EvaluatedFrames, EveryNthBeginsWithTheFirst) {
  std::vector<EvaluatedFrame> frames;
  frames.reserve(7);
  for (std::int64_t utime = 0; utime < 7; ++utime) frames.push_back(frame({object("mug", kLeft)}, {}, utime));
  const auto selected = [&](int every) {
    std::vector<std::int64_t> utimes;
    for (const EvaluatedFrame& kept : every_nth(frames, every)) {
      EXPECT_EQ(kept.objects.size(), 1U);
      utimes.push_back(kept.utime);
    }
    return utimes;
  };
  EXPECT_EQ(selected(1), (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(selected(3), (std::vector<std::int64_t>{0, 3, 6}));
  EXPECT_EQ(selected(7), (std::vector<std::int64_t>{0}));
  EXPECT_TRUE(every_nth({}, 2).empty());
}

const Points kCorners = {{0.1F, 0, 0}, {-0.1F, 0, 0}, {0, 0.1F, 0}, {0, -0.1F, 0}};

TEST(PoseMetrics, AShiftIsItsOwnAdd) {
  const Eigen::Isometry3d shifted(Eigen::Translation3d(0.003, 0.004, 0.0));
  EXPECT_NEAR(add_error(kCorners, shifted, Eigen::Isometry3d::Identity()), 0.005, 1e-7);
  EXPECT_NEAR(add_s_error(kCorners, shifted, Eigen::Isometry3d::Identity()), 0.005, 1e-7);
}

TEST(PoseMetrics, AddSForgivesASymmetryAndAddDoesNot) {
  const Eigen::Isometry3d quarter(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(add_s_error(kCorners, quarter, Eigen::Isometry3d::Identity()), 0.0, 1e-7);
  EXPECT_NEAR(add_error(kCorners, quarter, Eigen::Isometry3d::Identity()), 0.1 * std::sqrt(2.0), 1e-6);
}

/// Returns three frames: a good pose, a bad one, none; each object visible by `visible`.
std::vector<EvaluatedFrame> posed_frames(double visible) {
  std::vector<EvaluatedFrame> frames;
  for (int i = 0; i < 3; ++i) {
    frames.push_back(frame({object("mug", kLeft, visible)}, {detection("mug", kLeft, 0.5F)}));
    ObjectPose pose;
    pose.detection_index = 0;
    pose.status = i < 2 ? PoseStatus::kValid : PoseStatus::kNotConverged;
    if (i < 2) pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, i == 0 ? 0.001 : 0.05));
    frames.back().poses = ObjectPoses{{}, {pose}, {}};
  }
  return frames;
}

TEST(PoseMetrics, RecallCountsGoodPosesOverTrueDetections) {
  const PoseModel model{kCorners, 0.2};
  const std::vector<EvaluatedFrame> frames = posed_frames(0.6);
  const auto judged = match_poses(frames, evaluate_class(frames, "mug", {}), model);
  ASSERT_EQ(judged.size(), 3U);
  EXPECT_NEAR(judged[1].add_s, 0.05, 1e-6);
  EXPECT_TRUE(std::isnan(judged[2].add));
  EXPECT_EQ(judged[2].status, PoseStatus::kNotConverged);
  EXPECT_NEAR(add_s_recall(judged, model.diameter, 0.5), 1.0 / 3.0, 1e-12);
  EXPECT_TRUE(std::isnan(add_s_recall(judged, model.diameter, 0.7))) << "none visible enough";
}

Eigen::Isometry3d rotated(double angle_rad, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(angle_rad, axis));
}

TEST(PoseMetrics, ABoxThatIsTurnedFrontForBackIsRightUpToItsShapeOnly) {
  const Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
  const PoseModel printed{kCorners, 0.2};
  EXPECT_NEAR(strict_error(printed, rotated(M_PI), truth), 0.2, 1e-6);
  EXPECT_FALSE(is_correct(printed, rotated(M_PI), truth));
  EXPECT_TRUE(is_correct_up_to_shape(printed, rotated(M_PI), truth));
  const PoseModel plain{kCorners, 0.2, {truth, rotated(M_PI)}};
  EXPECT_NEAR(strict_error(plain, rotated(M_PI), truth), 0.0, 1e-6);
  EXPECT_TRUE(is_correct(plain, rotated(M_PI), truth)) << "the dataset says that it is the same pose";
}

TEST(PoseMetrics, OfASymmetricObjectThePointThatIsFarthestOffCounts) {
  const Eigen::Isometry3d tilted = rotated(0.3, Eigen::Vector3d::UnitX());  // two corners stay, two move by 0.03 m
  const Eigen::Isometry3d truth = Eigen::Isometry3d::Identity();
  const PoseModel printed{kCorners, 0.2};
  EXPECT_NEAR(strict_error(printed, tilted, truth), 0.1 * std::sin(0.15), 1e-6) << "ADD";
  EXPECT_TRUE(is_correct(printed, tilted, truth));
  const PoseModel plain{kCorners, 0.2, {truth, rotated(M_PI)}};
  EXPECT_NEAR(strict_error(plain, tilted, truth), 0.2 * std::sin(0.15), 1e-6) << "MSSD";
  EXPECT_FALSE(is_correct(plain, tilted, truth));
}

TEST(PoseMetrics, TheSymmetriesOfTheDatasetAreExpanded) {
  Mesh mesh;
  mesh.vertices = kCorners;
  mesh.triangles = {{0, 2, 3}, {1, 3, 2}};
  EXPECT_FALSE(make_pose_model(mesh, {}).is_symmetric());
  Symmetries quarter;
  quarter.continuous.push_back({});
  EXPECT_TRUE(is_correct(make_pose_model(mesh, quarter), rotated(1.234), Eigen::Isometry3d::Identity()));
}

TEST(PoseMetrics, ATurnedPoseIsPublishedWrongAndRightUpToItsShape) {
  std::vector<EvaluatedFrame> frames = posed_frames(1.0);  // right, wrong, none
  frames[0].poses->poses[0].T_camera_object = rotated(M_PI);
  frames[0].poses->poses[0].quality = frames[0].poses->poses[0].shape_quality = 0.95F;
  std::map<std::string, PoseModel> models = {{"mug", {kCorners, 0.2}}};
  const Evaluation printed = evaluate(frames, {"mug"}, models, {});
  EXPECT_EQ(printed.published->correct, 0);
  EXPECT_EQ(printed.published->correct_up_to_shape, 1);
  EXPECT_EQ(printed.strict_recall.at("mug"), 0.0);
  EXPECT_NEAR(printed.add_s_recall.at("mug"), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(printed.pose_calibration.bins[9].true_fraction, 0.0) << "a quality of 0.95 says that it is right";
  EXPECT_EQ(printed.pose_calibration_up_to_shape.bins[9].true_fraction, 1.0);
  models.at("mug").symmetries.push_back(rotated(M_PI));
  EXPECT_NEAR(evaluate(frames, {"mug"}, models, {}).strict_recall.at("mug"), 1.0 / 3.0, 1e-12);
}

TEST(PoseMetrics, ATurnedObjectIsRightByAddOnlyWhereItIsSymmetric) {
  std::vector<EvaluatedFrame> frames = posed_frames(1.0);
  frames[0].poses->poses[0].T_camera_object = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
  const PoseModel plain{kCorners, 0.2};
  const PoseModel symmetric{kCorners, 0.2, {Eigen::Isometry3d::Identity(), rotated(M_PI)}};
  const auto judged = match_poses(frames, evaluate_class(frames, "mug", {}), plain);
  EXPECT_NEAR(add_or_add_s_recall(judged, symmetric, 0.5), 1.0 / 3.0, 1e-12);
  EXPECT_EQ(add_or_add_s_recall(judged, plain, 0.5), 0.0);
}

TEST(PoseMetrics, ObjectsWithoutTruePosesAreLeftOut) {
  std::vector<EvaluatedFrame> frames = posed_frames(1.0);
  frames[2].objects[0].truth.has_pose = false;
  EXPECT_EQ(match_poses(frames, evaluate_class(frames, "mug", {}), {kCorners, 0.2}).size(), 2U);
}

TEST(PoseMetrics, AFrameThatThePosesPassedOverCountsAsMissedUnlessProcessedFramesAreAskedFor) {
  std::vector<EvaluatedFrame> frames = posed_frames(1.0);
  frames[1].poses.reset();
  frames[2].poses.reset();
  const std::map<std::string, PoseModel> models = {{"mug", {kCorners, 0.2}}};
  EvaluationRules rules;
  EXPECT_NEAR(evaluate(frames, {"mug"}, models, rules).add_s_recall.at("mug"), 1.0 / 3.0, 1e-12);
  rules.processed_only = true;
  EXPECT_NEAR(evaluate(frames, {"mug"}, models, rules).add_s_recall.at("mug"), 1.0, 1e-12);
  frames[0].poses.reset();
  EXPECT_TRUE(evaluate(frames, {"mug"}, models, {}).add_s_recall.empty()) << "nobody looked for poses";
}

TEST(PoseMetrics, PublishedPosesOfFalseDetectionsAndThoseOffAreWrong) {
  std::vector<EvaluatedFrame> frames = posed_frames(1.0);  // right, wrong, none
  frames[0].detections->detections.push_back(detection("mug", kRight, 0.4F));
  ObjectPose of_false = frames[0].poses->poses[0];
  of_false.detection_index = 1;
  frames[0].poses->poses.push_back(of_false);
  const std::map<std::string, PoseModel> models = {{"mug", {kCorners, 0.2}}};
  const Evaluation evaluation = evaluate(frames, {"mug"}, models, {});
  EXPECT_EQ(evaluation.published->count, 3);
  EXPECT_EQ(evaluation.published->correct, 1);
  EXPECT_EQ(evaluation.pose_calibration.count, 3);
}

TEST(PoseMetrics, QualityIsJudgedByWithheldPosesToo) {
  std::vector<EvaluatedFrame> frames = posed_frames(1.0);
  frames[0].unfiltered_poses = frames[0].poses;
  frames[0].unfiltered_poses->poses[0].quality = 0.3F;
  frames[0].poses->poses[0].T_camera_object.reset();
  const std::map<std::string, PoseModel> models = {{"mug", {kCorners, 0.2}}};
  const Evaluation evaluation = evaluate(frames, {"mug"}, models, {});
  EXPECT_EQ(evaluation.published->count, 1);
  EXPECT_EQ(evaluation.published->correct, 0);
  EXPECT_EQ(evaluation.pose_calibration.count, 2);
  EXPECT_EQ(evaluation.pose_calibration.bins[3].true_fraction, 1.0);
  EXPECT_EQ(evaluation.add_s_recall.at("mug"), 0.0) << "as published";
}

TEST(PoseMetrics, CandidatesCountWhereAPoseHasConfirmedThem) {
  std::vector<EvaluatedFrame> frames = posed_frames(1.0);  // right, wrong, none
  frames[0].detections->detections[0].reported = false;
  frames[2].detections->detections[0].reported = false;
  EvaluationRules rules;
  rules.operating_score = 0.4F;
  const std::map<std::string, PoseModel> models = {{"mug", {kCorners, 0.2}}};
  const Evaluation evaluation = evaluate(frames, {"mug"}, models, rules);
  EXPECT_EQ(evaluation.add_s_recall.at("mug"), 0.5) << "the third is not reported";
  EXPECT_EQ(evaluation.operating.at("mug").correct.detections, 1);
  EXPECT_EQ(evaluation.operating.at("mug").correct.confirmed, 1);
  rules.operating_score = 0.6F;
  EXPECT_EQ(evaluate(frames, {"mug"}, models, rules).operating.at("mug").correct.all(), 1)
      << "confirmed, whatever its score";
}

TEST(PoseMetrics, AConfirmedCandidateThatIsNotThereIsAFalseDetection) {
  std::vector<EvaluatedFrame> frames = posed_frames(1.0);
  frames[0].detections->detections.push_back(detection("mug", kRight, 0.2F));
  frames[0].detections->detections[1].reported = false;
  EXPECT_EQ(evaluate(frames, {"mug"}, {}, {}).false_detections, 0);
  ObjectPose of_false = frames[0].poses->poses[0];
  of_false.detection_index = 1;
  frames[0].poses->poses.push_back(of_false);
  EXPECT_EQ(evaluate(frames, {"mug"}, {}, {}).false_detections, 1);
}

fs::path write_csv(const std::string& text) {
  fs::path file = fs::temp_directory_path() / "houghstream_latency_test.csv";
  std::ofstream(file) << text;
  return file;
}

TEST(Latency, ObserverFileGivesDifferencesAndSkipsWhatNeverCame) {
  const Latencies latencies =
      read_latencies(write_csv("utime,t_frame,t_detections,t_poses\n1,0.5,0.625,0.875\n2,1,1.25,1.125\n3,2,,\n"));
  EXPECT_EQ(latencies.frames, 3);
  EXPECT_EQ(latencies.detect_ms, (std::vector<double>{125.0, 250.0}));
  EXPECT_EQ(latencies.pose_ms, (std::vector<double>{250.0})) << "poses that were followed come before the detections";
  EXPECT_EQ(latencies.total_ms, (std::vector<double>{375.0, 125.0}));
}

TEST(Latency, BadObserverFilesAreRefused) {
  EXPECT_THROW(read_latencies("/no/such/file.csv"), InputError);
  EXPECT_THROW(read_latencies(write_csv("")), InputError);
  EXPECT_THROW(read_latencies(write_csv("utime,t_frame\n")), InputError);
  EXPECT_THROW(read_latencies(write_csv("utime,t_frame,t_detections,t_poses\n1,2,3\n")), InputError);
  EXPECT_THROW(read_latencies(write_csv("utime,t_frame,t_detections,t_poses\n1,2,x,4\n")), InputError);
}

}  // namespace
}  // namespace houghstream
