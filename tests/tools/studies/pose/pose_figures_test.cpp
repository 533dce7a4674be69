#include "tools/studies/pose/pose_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tools/studies/pose/bench_report.hpp"

namespace houghstream {
namespace {

PoseTrial withheld(MatchOutcome outcome, double visible, PoseStatus status) {
  PoseTrial trial;
  trial.scene = "desk";
  trial.class_name = "mug";
  trial.score = 0.9F;
  trial.outcome = outcome;
  trial.visible_fraction = visible;
  trial.distance_m = 2.0;
  trial.ms = 100.0;
  trial.status = status;
  return trial;
}

/// Returns a trial of an object without symmetries: ADD decides whether it is correct.
PoseTrial published(MatchOutcome outcome, double ms, double add_s, double add) {
  PoseTrial trial = withheld(outcome, 1.0, PoseStatus::kValid);
  trial.T_camera_object = Eigen::Isometry3d::Identity();
  trial.ms = ms;
  trial.add_s = add_s;
  trial.add = add;
  trial.strict = add;
  trial.shift_m = 0.001 * ms;
  trial.angle_deg = 2.0 * ms;
  return trial;
}

TEST(PoseFigures, TimesAndErrorsAreMediansOverPublishedPoses) {
  const std::vector<PoseTrial> trials = {published(MatchOutcome::kTruePositive, 1.0, 0.02, 0.02),
                                         published(MatchOutcome::kTruePositive, 3.0, 0.02, 0.02),
                                         published(MatchOutcome::kTruePositive, 8.0, 0.02, 0.02),
                                         withheld(MatchOutcome::kTruePositive, 1.0, PoseStatus::kRejectedByDepth)};
  const PoseFigures figures = pose_figures(trials);
  EXPECT_EQ(figures.detections, 4);
  EXPECT_EQ(figures.published, 3);
  EXPECT_NEAR(figures.ms_median, 3.0, 1e-12);
  EXPECT_NEAR(figures.ms_p99, 8.0, 1e-12);
  EXPECT_NEAR(figures.mm_median, 3.0, 1e-12);
  EXPECT_NEAR(figures.mm_per_m_sq_median, 0.75, 1e-12);
  EXPECT_NEAR(figures.deg_median, 6.0, 1e-12);
}

TEST(PoseFigures, WithheldPosesCountAsNotFound) {
  std::vector<PoseTrial> trials = {
      published(MatchOutcome::kTruePositive, 1.0, 0.05, 0.2), published(MatchOutcome::kTruePositive, 1.0, 0.2, 0.3),
      withheld(MatchOutcome::kTruePositive, 0.7, PoseStatus::kRejectedByColour),
      withheld(MatchOutcome::kTruePositive, 0.5, PoseStatus::kRejectedByColour),  // too little visible
      withheld(MatchOutcome::kFalsePositive, 1.0, PoseStatus::kLowScore)};
  PoseRecall recall = pose_recall(trials, 0.0F);
  EXPECT_EQ(recall.detections, 3);
  EXPECT_NEAR(recall.add_s, 1.0 / 3.0, 1e-12);
  EXPECT_NEAR(recall.add, 0.0, 1e-12);
  EXPECT_NEAR(recall.correct, 0.0, 1e-12) << "right up to its shape only";
  trials[0].symmetric = true;  // ADD-S speaks for ADD
  trials[1].score = 0.3F;
  recall = pose_recall(trials, 0.5F);
  EXPECT_EQ(recall.detections, 2);
  EXPECT_NEAR(recall.add, 0.5, 1e-12);
  EXPECT_NEAR(recall.correct, 0.0, 1e-12) << "MSSD speaks for itself";
}

TEST(PoseFigures, GoodAreRightPosesOfTrueDetectionsAmongAllPublished) {
  const PoseFigures figures = pose_figures(
      {published(MatchOutcome::kTruePositive, 1.0, 0.05, 0.2), published(MatchOutcome::kTruePositive, 1.0, 0.2, 0.2),
       published(MatchOutcome::kFalsePositive, 1.0, 0.05, 0.2), published(MatchOutcome::kIgnored, 1.0, 0.05, 0.2),
       withheld(MatchOutcome::kTruePositive, 1.0, PoseStatus::kLowScore),
       published(MatchOutcome::kTruePositive, 1.0, 0.01, 0.02)});
  EXPECT_NEAR(figures.good_fraction, 0.5, 1e-12);
  EXPECT_NEAR(figures.correct_fraction, 0.25, 1e-12);
}

TEST(PoseFigures, WhatWasNotThereIsNullAndNoNumber) {
  const OrderedJson json = to_json(pose_figures({withheld(MatchOutcome::kFalsePositive, 1.0, PoseStatus::kLowScore)}));
  EXPECT_EQ(json["detections"], 1);
  for (const char* key :
       {"ms_median", "ms_p99", "mm_median", "deg_median", "published_right_fraction", "published_good_fraction"})
    EXPECT_TRUE(json[key].is_null()) << key;
  EXPECT_TRUE(json["recall"]["mssd"].is_null());
  EXPECT_TRUE(json["recall"]["add_s"].is_null());
}

TEST(PoseFigures, WithheldPosesAreCountedByReasonAndByWhatTheyWouldHaveBeen) {
  const std::vector<PoseTrial> trials = {withheld(MatchOutcome::kTruePositive, 1.0, PoseStatus::kLowScore),
                                         withheld(MatchOutcome::kTruePositive, 1.0, PoseStatus::kLowScore),
                                         withheld(MatchOutcome::kFalsePositive, 1.0, PoseStatus::kRejectedByDepth),
                                         published(MatchOutcome::kTruePositive, 1.0, 0.02, 0.02)};
  const std::vector<PoseTrial> unchecked = {published(MatchOutcome::kTruePositive, 1.0, 0.02, 0.5),
                                            published(MatchOutcome::kTruePositive, 1.0, 0.4, 0.4),
                                            published(MatchOutcome::kFalsePositive, 1.0, 0.02, 0.02),
                                            published(MatchOutcome::kTruePositive, 1.0, 0.02, 0.02)};
  const std::map<std::string, WithheldPoses> counts = count_withheld(trials, unchecked);
  ASSERT_EQ(counts.size(), 2U);
  EXPECT_EQ(counts.at("low score").of_true, 2);
  EXPECT_EQ(counts.at("low score").correct, 0);
  EXPECT_EQ(counts.at("low score").correct_up_to_shape, 1);
  EXPECT_EQ(counts.at("rejected by depth").of_false, 1);
  EXPECT_EQ(counts.at("rejected by depth").correct_up_to_shape, 0);
  const OrderedJson json = to_json(counts);
  EXPECT_EQ(json["low score"]["would_have_been_right"], 1) << "an older figure, by ADD-S";
  EXPECT_EQ(json["low score"]["would_have_been_right_by_mssd"], 0);
  EXPECT_THROW(count_withheld(trials, {}), std::logic_error);
}

TEST(WorstPoses, FalseOnesComeFirstAndUnknownErrorsBeforeAll) {
  const double unknown = PoseTrial::kUnknown;
  const std::vector<PoseTrial> worst = worst_poses(
      {published(MatchOutcome::kTruePositive, 1.0, 0.02, 0.02), published(MatchOutcome::kTruePositive, 2.0, 0.01, 0.9),
       published(MatchOutcome::kFalsePositive, 3.0, 0.1, 0.1), published(MatchOutcome::kIgnored, 4.0, 2.0, 2.0),
       published(MatchOutcome::kFalsePositive, 5.0, unknown, unknown),
       withheld(MatchOutcome::kTruePositive, 1.0, PoseStatus::kLowScore)},
      3);
  ASSERT_EQ(worst.size(), 3U);
  EXPECT_EQ(worst[0].ms, 5.0);
  EXPECT_EQ(worst[1].ms, 3.0);
  EXPECT_EQ(worst[2].ms, 2.0);
}

TEST(PoseTable, WhatIsUnknownIsEmpty) {
  EXPECT_EQ(
      pose_table_rows("ours", {withheld(MatchOutcome::kFalsePositive, PoseTrial::kUnknown, PoseStatus::kLowScore)}),
      "ours,desk,0,mug,,false,0.9000,low score,0.0000,,,,,100.000,\n");
}

}  // namespace
}  // namespace houghstream
