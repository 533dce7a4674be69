#include "tools/studies/failures/failures.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

NamedObject object(const std::string& name, double visible) {
  NamedObject out;
  out.class_name = name;
  out.truth.box_visible_px = cv::Rect(100, 100, 40, 60);
  out.truth.visible_fraction = visible;
  return out;
}

Detection detection(const std::string& name, const cv::Rect2f& box, float score) {
  Detection out;
  out.class_name = name;
  out.box_px = box;
  out.score = score;
  return out;
}

// Returns a mug in each of twelve frames, found in none of the last six, and a false one that grows surer.
std::vector<EvaluatedFrame> twelve_frames() {
  std::vector<EvaluatedFrame> frames(12);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    frames[f].objects = {object("mug", 0.3 + 0.05 * static_cast<double>(f))};
    frames[f].detections.emplace();
    auto& found = frames[f].detections->detections;
    if (f < 6) found.push_back(detection("mug", {101, 99, 40, 60}, 0.9F));
    found.push_back(detection("mug", {300, 100, 40, 60}, 0.3F + 0.05F * static_cast<float>(f)));
  }
  return frames;
}

TEST(Failures, TheGravestOfEachKindComeFirstAndApart) {
  const std::vector<Failure> selected = choose_failures(twelve_frames(), {"mug"}, {{}, 0.5F, 4, 3});
  ASSERT_EQ(selected.size(), 4U);
  EXPECT_EQ(selected[0].kind, Failure::Kind::kFalse);
  EXPECT_EQ(selected[0].frame, 11U);
  EXPECT_EQ(selected[1].kind, Failure::Kind::kMissed);
  EXPECT_EQ(selected[1].frame, 11U);
  EXPECT_NEAR(selected[1].weight, 0.85, 1e-9);
  EXPECT_EQ(selected[2].frame, 8U);
  EXPECT_EQ(selected[3].frame, 8U);
}

TEST(Failures, BelowTheOperatingScoreNothingIsFalseAndMoreIsMissed) {
  const std::vector<Failure> selected = choose_failures(twelve_frames(), {"mug"}, {{}, 0.95F, 100, 1});
  EXPECT_EQ(selected.size(), 12U);
  for (const Failure& failure : selected) EXPECT_EQ(failure.kind, Failure::Kind::kMissed);
}

TEST(Failures, HardlyVisibleObjectsAreNotMissed) {
  std::vector<EvaluatedFrame> frames(1);
  frames[0].objects = {object("mug", 0.05)};
  frames[0].detections.emplace();
  EXPECT_TRUE(choose_failures(frames, {"mug"}, {{}, 0.5F, 4, 1}).empty());
}

TEST(Failures, AnImageHasTheBoxInItEvenAtTheFramesEdge) {
  const cv::Mat grey(480, 640, CV_8UC3, cv::Scalar(90, 90, 90));
  for (const cv::Rect2f& box : {cv::Rect2f(0, 0, 30, 30), cv::Rect2f(600, 450, 40, 30), cv::Rect2f(0, 0, 640, 480)}) {
    Failure missed;
    missed.kind = Failure::Kind::kMissed;
    missed.class_name = "mug";
    missed.box_px = box;
    missed.weight = 0.4;
    const cv::Mat tile = draw_failure(missed, grey);
    cv::Mat yellow;
    cv::inRange(tile, cv::Scalar(60, 220, 255), cv::Scalar(60, 220, 255), yellow);
    EXPECT_GT(cv::countNonZero(yellow), 100);
  }
}

TEST(Failures, TilesAreJoinedRowByRow) {
  const std::vector<cv::Mat> tiles(5, cv::Mat(20, 30, CV_8UC3, cv::Scalar(255, 255, 255)));
  const cv::Mat joined = join_tiles(tiles, 3);
  EXPECT_EQ(joined.size(), cv::Size(3 * 34 - 4, 2 * 24 - 4));
  EXPECT_EQ(joined.at<cv::Vec3b>(30, 40)[0], 255);
  EXPECT_EQ(joined.at<cv::Vec3b>(30, 80)[0], 60);
  EXPECT_FALSE(join_tiles({}, 3).empty());
}

}  // namespace
}  // namespace houghstream
