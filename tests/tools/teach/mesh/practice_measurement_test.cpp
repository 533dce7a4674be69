#include "tools/teach/mesh/practice_measurement.hpp"

#include <gtest/gtest.h>

namespace houghstream::teach {
namespace {

constexpr float kReportedFrom = 0.65F;

void stand(const std::string& name, const cv::Rect& box_px, double visible_fraction, EvaluatedFrame& frame) {
  NamedObject object{name, {}};
  object.truth.box_visible_px = box_px;
  object.truth.visible_fraction = visible_fraction;
  object.truth.T_camera_object = Eigen::Isometry3d::Identity();
  object.truth.T_camera_object.translation() = Eigen::Vector3d(0.0, 0.0, 1.1);
  object.truth.has_pose = true;
  frame.objects.push_back(object);
}

void find(const std::string& name, const cv::Rect& box_px, float score, EvaluatedFrame& frame) {
  Detection detection;
  detection.class_name = name;
  detection.box_px = box_px;
  detection.score = score;
  frame.detections->detections.push_back(detection);
}

const cv::Rect kLeft(100, 100, 80, 80);
const cv::Rect kRight(300, 100, 80, 80);

/// A mug on the left and a bowl on the right of the first frame, a half hidden mug in the second, a hardly visible one
/// in the third.
quality::FoundPoses three_frames() {
  quality::FoundPoses found;
  found.frames.resize(3);
  for (EvaluatedFrame& frame : found.frames) frame.detections = Detections();
  stand("mug", kLeft, 1.0, found.frames[0]);
  stand("bowl", kRight, 1.0, found.frames[0]);
  stand("mug", kLeft, 0.4, found.frames[1]);
  stand("mug", kLeft, 0.05, found.frames[2]);
  return found;
}

quality::Example pose_of(std::size_t frame, float score, bool is_right) {
  quality::Example example;
  example.frame = frame;
  example.score = score;
  example.is_present = is_right;
  example.is_correct_up_to_shape = is_right;
  return example;
}

TEST(PracticeMeasurement, CountsWhatWouldBePublishedByDefault) {
  quality::FoundPoses found = three_frames();
  const std::vector<quality::Example> examples = {pose_of(0, 0.9F, true), pose_of(1, 0.3F, true),
                                                  pose_of(1, 0.5F, false), pose_of(2, 0.7F, false),
                                                  pose_of(2, 0.05F, true)};
  const std::vector<float> qualities = {0.62F, 0.7F, 0.8F, 0.3F, 0.99F};
  const store::PracticeRecord record =
      measure_practice({"mug", {0.0F, 0.0F, 0.3F}}, found, examples, qualities, kReportedFrom);
  EXPECT_EQ(record.shown, 2) << "the third is not required";
  EXPECT_EQ(record.right, 1) << "a candidate's quality of 0.7 is too low";
  EXPECT_EQ(record.wrong, 1);
  int in_curve = 0;
  if (!record.qualities.empty()) in_curve = record.qualities.back().right + record.qualities.back().wrong;
  EXPECT_EQ(in_curve, 4) << "hs-detect hands the weakest on to nobody";
  ASSERT_EQ(record.by_distance.size(), 6U);
  EXPECT_EQ(record.by_distance[4].shown, 2) << "its middle is 1.4 m away";
  EXPECT_EQ(record.by_distance[4].found, 1);
  EXPECT_EQ(record.by_visible[1].shown, 1);
  EXPECT_EQ(record.by_visible[1].found, 0);
  EXPECT_EQ(record.by_visible.back().shown, 1) << "1 is in the last bin";
  EXPECT_EQ(record.by_visible.back().found, 1);
}

TEST(PracticeMeasurement, TheCurveOfScoresIsOfAllDetections) {
  quality::FoundPoses found = three_frames();
  find("mug", kLeft, 0.9F, found.frames[0]);
  find("mug", kRight, 0.3F, found.frames[0]);
  find("mug", kLeft, 0.8F, found.frames[2]);  // of what is hardly visible, and so neither right nor wrong
  const store::PracticeRecord record = measure_practice({"mug", {}}, found, {}, {}, kReportedFrom);
  ASSERT_EQ(record.scores.size(), 2U);
  EXPECT_EQ(record.scores[0].right, 1);
  EXPECT_EQ(record.scores[1].wrong, 1);
  EXPECT_TRUE(record.qualities.empty());
}

TEST(PracticeMeasurement, WhatIsReportedInAnObjectsPlaceIsWhatItIsTakenFor) {
  quality::FoundPoses found = three_frames();
  find("bowl", kLeft, 0.7F, found.frames[0]);
  find("bowl", kLeft, 0.66F, found.frames[0]);  // once more, in the same place
  find("can", kLeft, 0.6F, found.frames[0]);    // too weak to be reported
  find("bowl", kRight, 0.9F, found.frames[0]);  // is there
  find("can", kLeft, 0.9F, found.frames[1]);
  find("bowl", kLeft, 0.9F, found.frames[1]);
  const store::PracticeRecord mug = measure_practice({"mug", {}}, found, {}, {}, kReportedFrom);
  EXPECT_EQ(mug.taken_for, (std::map<std::string, int>{{"bowl", 2}, {"can", 1}}));
  EXPECT_TRUE(measure_practice({"bowl", {}}, found, {}, {}, kReportedFrom).taken_for.empty());
}

}  // namespace
}  // namespace houghstream::teach
