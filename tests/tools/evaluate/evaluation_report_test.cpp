#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tests/test_files.hpp"
#include "tools/evaluate/metrics/result_log.hpp"
#include "tools/evaluate/report.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const cv::Rect kBox(10, 10, 50, 50);

Detection detect(const std::string& name, const cv::Rect& box, float score) {
  Detection out;
  out.class_id = 1;
  out.class_name = name;
  out.box_px = box;
  out.score = score;
  return out;
}

/// Returns two frames with a mug in each: found with a good pose beside a wrong bottle, and skipped.
std::vector<EvaluatedFrame> two_frames() {
  std::vector<EvaluatedFrame> frames(2);
  for (std::size_t i = 0; i < 2; ++i) {
    frames[i].scene = "desk";
    frames[i].image_id = 7;
    frames[i].utime = static_cast<std::int64_t>(i);
    NamedObject mug;
    mug.class_name = "mug";
    mug.truth.box_visible_px = kBox;
    frames[i].objects = {mug};
  }
  frames[0].detections =
      Detections{{}, {detect("mug", kBox, 0.9F), detect("bottle", kBox, 0.4F)}, {{"detect.leaves", 4000}}};
  ObjectPose pose;
  pose.detection_index = 0;
  pose.status = PoseStatus::kValid;
  pose.quality = pose.shape_quality = 0.8F;
  pose.T_camera_object = Eigen::Isometry3d::Identity();
  frames[0].poses = ObjectPoses{{}, {pose}, {{"detect.leaves", 4000}, {"pose.icp", 2000}}};
  return frames;
}

const std::map<std::string, PoseModel> kModels = {{"mug", {{{0.0F, 0.0F, 0.1F}}, 0.2}}};

TEST(EvaluationReport, SummaryHoldsTheFigures) {
  const EvaluationRules rules;
  const Evaluation evaluation = evaluate(two_frames(), {"mug", "can"}, kModels, rules);
  Latencies latencies;
  latencies.detect_ms = {5.0};
  const OrderedJson json = summary_json(evaluation, rules, latencies);
  EXPECT_EQ(json["frames"], 2);
  EXPECT_EQ(json["frames_processed"], 1);
  EXPECT_EQ(json["auc"]["mug"], 0.5);
  EXPECT_TRUE(json["auc"]["can"].is_null());
  EXPECT_EQ(json["auc"]["mean"], 0.5);
  EXPECT_EQ(json["precision"]["mug"], 1.0);
  EXPECT_EQ(json["recall"]["mug"], 0.5);
  EXPECT_EQ(json["false_detections"], 1) << "the bottle, though it is not listed";
  EXPECT_EQ(json["false_per_frame"], 1.0);
  EXPECT_EQ(json["pose_recall_add_s_10"]["mug"], 1.0);
  EXPECT_EQ(json["latency_ms"]["detect"]["p50"], 5.0);
  EXPECT_TRUE(json["latency_ms"]["pose"]["p50"].is_null());
  EXPECT_EQ(json["stage_ms_median"]["pose.icp"], 2.0);
}

TEST(EvaluationReport, PosesAreNotCountedWithoutModels) {
  const EvaluationRules rules;
  const Evaluation with = evaluate(two_frames(), {"mug"}, kModels, rules);
  EXPECT_EQ(summary_json(with, rules, std::nullopt)["published"], 1);
  EXPECT_NE(summary_table(with, rules).find("poses published 1, right 1"), std::string::npos);
  const Evaluation without = evaluate(two_frames(), {"mug"}, {}, rules);
  EXPECT_TRUE(summary_json(without, rules, std::nullopt)["published"].is_null());
  EXPECT_TRUE(summary_json(without, rules, std::nullopt)["published_good_fraction"].is_null());
  EXPECT_EQ(summary_table(without, rules).find("poses published"), std::string::npos);
  EXPECT_NE(summary_table(without, rules).find("poses not judged"), std::string::npos);
}

TEST(EvaluationReport, AverageRecallsStandInTheSummaryWhereTheyWereMeasured) {
  const EvaluationRules rules;
  Evaluation evaluation = evaluate(two_frames(), {"mug"}, kModels, rules);
  EXPECT_FALSE(summary_json(evaluation, rules, std::nullopt).contains("bop19"));
  EXPECT_EQ(summary_json(evaluation, rules, std::nullopt)["pose_recall_add_or_add_s_10"]["mean"], 1.0);
  AverageRecall recall;
  recall.targets = 2;
  recall.vsd = 0.3;
  recall.mssd = 0.5;
  recall.mspd = recall.mean = 0.4;
  evaluation.localisation = LocalisationScores{{{"mug", recall}}, recall};
  const OrderedJson bop = summary_json(evaluation, rules, std::nullopt)["bop19"];
  EXPECT_EQ(bop["targets"]["mug"], 2);
  EXPECT_EQ(bop["ar_vsd"]["mug"], 0.3);
  EXPECT_EQ(bop["ar_mssd"]["all"], 0.5);
  EXPECT_EQ(bop["ar_mspd"]["all"], 0.4);
  EXPECT_EQ(bop["ar"]["all"], 0.4);
  EXPECT_NE(summary_table(evaluation, rules).find("0.400 of 2 targets"), std::string::npos);
}

TEST(EvaluationReport, PosesOfFollowedObjectsStandInTheSummaryWhereThereAreAny) {
  EvaluationRules rules;
  std::vector<EvaluatedFrame> frames = two_frames();
  EXPECT_FALSE(summary_json(evaluate(frames, {"mug"}, kModels, rules), rules, std::nullopt).contains("followed"));
  frames[0].followed = frames[0].poses;
  frames[0].followed->poses[0].class_name = "mug";
  rules.processed_only = true;
  const Evaluation evaluation = evaluate(frames, {"mug"}, kModels, rules);
  const OrderedJson followed = summary_json(evaluation, rules, std::nullopt)["followed"];
  EXPECT_EQ(followed["frames"], 1);
  EXPECT_EQ(followed["frames_missed"], 1);
  EXPECT_EQ(followed["required"]["mug"], 2) << "frames without detections count too";
  EXPECT_EQ(followed["right_fraction"]["all"], 1.0);
  EXPECT_EQ(followed["recall"]["mug"], 0.5);
  EXPECT_NE(summary_table(evaluation, rules).find("followed in 1 frames, 1 missed: 1 poses, 1 right"),
            std::string::npos);
}

TEST(EvaluationReport, ProposedScoresAreNotRounded) {
  constexpr float kScore = 0.758051F;
  std::vector<EvaluatedFrame> frames = two_frames();
  frames[0].detections->detections[0].score = kScore;
  const OrderedJson json = summary_json(evaluate(frames, {"mug"}, {}, {}), {}, {});
  EXPECT_EQ(json["detection_calibration"]["proposed"][0]["score"].get<float>(), kScore)
      << "a rounded one would leave out the very detection that it is of";
}

TEST(EvaluationReport, PrecisionAndRecallOfAllClassesAreThoseOfTheOperatingScore) {
  EvaluationRules rules;
  rules.operating_score = 0.5F;
  std::vector<EvaluatedFrame> frames = two_frames();
  frames[0].detections->detections.push_back(detect("mug", {200, 200, 50, 50}, 0.6F));
  frames[0].detections->detections.push_back(detect("can", {200, 200, 50, 50}, 0.4F));
  const OrderedJson operating = summary_json(evaluate(frames, {"mug", "can"}, {}, rules), rules, {})["operating"];
  EXPECT_EQ(operating, (OrderedJson{{"precision", 0.5},
                                    {"recall", 0.5},
                                    {"true", 1},
                                    {"false", 1},
                                    {"confirmed", {{"true", 0}, {"false", 0}}},
                                    {"required", 2}}));
}

TEST(EvaluationReport, CalibrationsHaveTheirErrorsBinsAndThresholds) {
  const EvaluationRules rules;
  const OrderedJson json = summary_json(evaluate(two_frames(), {"mug"}, kModels, rules), rules, {});
  EXPECT_EQ(json["detection_calibration"]["ece"], 0.1);
  EXPECT_EQ(json["detection_calibration"]["bins"].size(), 10U);
  EXPECT_EQ(json["detection_calibration"]["bins"][8]["count"], 1) << "0.9F is a little less than 0.9";
  EXPECT_EQ(json["detection_calibration"]["bins"][8]["mean_score"], 0.9);
  EXPECT_TRUE(json["detection_calibration"]["bins"][0]["true_fraction"].is_null());
  EXPECT_EQ(json["detection_calibration"]["proposed"][2]["precision"], 0.98);
  EXPECT_EQ(json["detection_calibration"]["proposed"][2]["score"].get<float>(), 0.9F);
  EXPECT_EQ(json["detection_calibration"]["proposed"][2]["recall"], 0.5) << "of what is required";
  EXPECT_EQ(json["pose_calibration"]["ece"], 0.2);
  EXPECT_EQ(json["pose_calibration"]["proposed"][0]["recall"], 1.0) << "of the right ones";
  EXPECT_EQ(json["published"], 1);
  EXPECT_EQ(json["published_right_fraction"], 1.0);
  EXPECT_EQ(json["published_good_fraction"], 1.0);
}

TEST(EvaluationReport, APoseThatIsRightUpToItsShapeOnlyIsToldFromARightOne) {
  const EvaluationRules rules;
  std::vector<EvaluatedFrame> frames = two_frames();
  Eigen::Isometry3d& T_camera_object = *frames[0].poses->poses[0].T_camera_object;
  T_camera_object = T_camera_object * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX());
  const std::map<std::string, PoseModel> models = {{"mug", {{{0.0F, 0.0F, 0.1F}, {0.0F, 0.0F, -0.1F}}, 0.2}}};
  const Evaluation evaluation = evaluate(frames, {"mug"}, models, rules);
  const OrderedJson json = summary_json(evaluation, rules, {});
  EXPECT_EQ(json["mssd_recall"]["mug"], 0.0);
  EXPECT_EQ(json["mssd_recall"]["mean"], 0.0);
  EXPECT_GT(json["pose_recall_add_s_10"]["mug"], 0.0);
  EXPECT_EQ(json["published_right_fraction"], 0.0);
  EXPECT_EQ(json["published_good_fraction"], 1.0);
  EXPECT_EQ(json["pose_calibration"]["ece"], 0.8);
  EXPECT_EQ(json["pose_calibration_up_to_shape"]["ece"], 0.2);
  const std::string table = summary_table(evaluation, rules);
  EXPECT_NE(table.find("poses published 1, right 0, right up to what the shape cannot tell 1"), std::string::npos);
  EXPECT_LT(table.find("right"), table.find("ADD-S<10%")) << "the strict figure comes first";
}

TEST(EvaluationReport, SeveralScenesHaveTheirOwnFigures) {
  const EvaluationRules rules;
  const Evaluation evaluation = evaluate(two_frames(), {"mug"}, {}, rules);
  const OrderedJson json = summary_json(evaluation, {{"desk", evaluation}, {"shelf", {}}}, rules, {});
  EXPECT_EQ(json["auc"]["mug"], 0.5);
  EXPECT_EQ(json["scenes"]["desk"]["auc"]["mug"], 0.5);
  EXPECT_EQ(json["scenes"]["shelf"]["frames"], 0);
  EXPECT_FALSE(json["scenes"]["desk"].contains("rules"));
}

TEST(EvaluationReport, TheRulesAreFollowed) {
  EvaluationRules rules;
  rules.processed_only = true;
  rules.operating_score = 0.5F;
  rules.ranked_from = 0.25F;
  const Evaluation evaluation = evaluate(two_frames(), {"mug"}, {}, rules);
  EXPECT_EQ(evaluation.classes[0].auc, 1.0);
  EXPECT_EQ(evaluation.false_detections, 0);
  EXPECT_TRUE(evaluation.poses.empty());
  EXPECT_EQ(summary_json(evaluation, rules, std::nullopt)["rules"]["ranked_from"], 0.25);
  EXPECT_NE(summary_table(evaluation, rules).find("from score 0.25 on"), std::string::npos);
}

TEST(EvaluationReport, WithAPrecisionEachClassCountsFromItsOwnScoreOn) {
  std::vector<EvaluatedFrame> frames = two_frames();
  frames[0].detections->detections.push_back(detect("mug", {200, 200, 50, 50}, 0.6F));
  EvaluationRules rules;
  rules.operating_score = 0.5F;
  EXPECT_EQ(evaluate(frames, {"mug"}, {}, rules).false_detections, 1);
  EXPECT_FALSE(summary_json(evaluate(frames, {"mug"}, {}, rules), rules, {})["rules"].contains("operating_scores"));
  rules.precision = 0.98;
  rules.class_operating_scores = {{"mug", 0.75F}};
  const Evaluation evaluation = evaluate(frames, {"mug"}, {}, rules);
  EXPECT_EQ(evaluation.false_detections, 0);
  EXPECT_EQ(evaluation.operating.at("mug").correct.all(), 1);
  EXPECT_EQ(evaluation.operating.at("mug").incorrect.all(), 0);
  const OrderedJson json = summary_json(evaluation, rules, {})["rules"];
  EXPECT_EQ(json["precision"], 0.98);
  EXPECT_EQ(json["operating_scores"]["mug"], 0.75);
  EXPECT_NE(summary_table(evaluation, rules).find("false detections 0 from the scores for precision 0.98 on"),
            std::string::npos);
}

TEST(EvaluationReport, FilesAreWrittenAsStated) {
  const EvaluationRules rules;
  const Evaluation evaluation = evaluate(two_frames(), {"mug"}, kModels, rules);
  const fs::path folder = fresh_folder("evaluation_report") / "new";
  write_report(evaluation, summary_json(evaluation, rules, std::nullopt), folder);
  EXPECT_EQ(read_text(folder / "curves.csv"), "object,score,precision,recall\nmug,0.9,1.000000,0.500000\n");
  EXPECT_EQ(read_text(folder / "poses.csv"),
            "frame,object,add,add_s,visible,status,score,quality,scene,image,strict\n"
            "0,mug,0.000000,0.000000,1.000,valid,0.9000,0.8000,desk,7,0.000000\n");
  EXPECT_TRUE(fs::exists(folder / "reliability.png"));
  EXPECT_EQ(read_json_object(folder / "summary.json")["auc"]["mug"], 0.5);
  write_text(folder / "file", "");
  EXPECT_THROW(write_report(evaluation, {}, folder / "file"), InputError);
}

template <typename Message>
void append(LogWriter& log, const std::string& name, const Message& message) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  log.write(message.utime, name, {bytes.data(), bytes.size()});
}

TEST(ResultLog, ResultsAreReadAndOthersPassedOver) {
  const std::vector<EvaluatedFrame> frames = two_frames();
  const fs::path file = fresh_folder("result_log") / "results.lcmlog";
  LogWriter log(file);
  append(log, channel::kDetections, to_message(*frames[0].detections));
  append(log, "SOMETHING_ELSE", to_message(*frames[0].detections));
  append(log, channel::kPoses, to_message(*frames[0].poses));
  log.close();
  const PublishedResults results = read_result_log(file);
  ASSERT_EQ(results.detections.size(), 1U);
  EXPECT_EQ(results.detections[0].detections[1].class_name, "bottle");
  ASSERT_EQ(results.poses.size(), 1U);
  EXPECT_EQ(results.poses[0].poses[0].status, PoseStatus::kValid);
}

TEST(ResultLog, OneOfSeveralCamerasIsChosenOrTheLogIsRefused) {
  const fs::path file = fresh_folder("result_log_cameras") / "results.lcmlog";
  LogWriter log(file);
  for (const std::string camera : {"LEFT", "RIGHT"}) {
    Detections detections = *two_frames()[0].detections;
    detections.frame.channel = camera;
    append(log, channel::kDetections, to_message(detections));
    ObjectPoses poses = *two_frames()[0].poses;
    poses.frame.channel = camera;
    append(log, channel::kPoses, to_message(poses));
  }
  log.close();
  EXPECT_THROW(read_result_log(file), InputError) << "a scene is what one camera saw";
  EXPECT_THROW(read_result_log(file, "ABOVE"), InputError);
  const PublishedResults results = read_result_log(file, "RIG.T");
  ASSERT_EQ(results.detections.size(), 1U);
  EXPECT_EQ(results.detections[0].frame.channel, "RIGHT");
  EXPECT_EQ(results.poses.size(), 1U);
}

TEST(ResultLog, PosesOfAnotherCameraThanTheDetectionsAreNotTakenForItsOwn) {
  const fs::path file = fresh_folder("result_log_followed") / "results.lcmlog";
  LogWriter log(file);
  Detections detections = *two_frames()[0].detections;
  detections.frame.channel = "LEFT";
  append(log, channel::kDetections, to_message(detections));
  ObjectPoses followed = *two_frames()[0].poses;
  followed.frame.channel = "RIGHT";
  append(log, channel::kPoses, to_message(followed));
  log.close();
  EXPECT_THROW(read_result_log(file), InputError);
  EXPECT_TRUE(read_result_log(file, "LEFT").poses.empty());
}

TEST(ResultLog, BadLogsAreRefused) {
  const fs::path folder = fresh_folder("result_log_bad");
  EXPECT_THROW(read_result_log(folder / "none.lcmlog"), InputError);
  const fs::path file = folder / "others.lcmlog";
  LogWriter log(file);
  append(log, "SOMETHING_ELSE", to_message(*two_frames()[0].detections));
  log.close();
  EXPECT_THROW(read_result_log(file), InputError) << "no results in it";
  fs::resize_file(file, fs::file_size(file) - 3);
  EXPECT_THROW(read_result_log(file), InputError) << "cut short";
}

}  // namespace
}  // namespace houghstream
