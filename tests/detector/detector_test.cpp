#include "detector/detector.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "detector/baseline/study_detector.hpp"
#include "detector/stages.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/detector/same_detections.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

Detections detect(const RgbdFrame& frame, int threads) {
  DetectionSettings settings;
  settings.threads = threads;
  settings.evidence.threshold = 0.5F;  // toys have learnt their scores from few images
  return Detector(toy::forest(), settings).detect(frame);
}

void expect_tile(int kind, double u, double v, double distance) {
  RgbdFrame frame = toy::background(77);
  frame.id.utime = 123456;
  const cv::Mat mask = toy::put_tile(kind, u, v, distance, frame);
  const Detections found = detect(frame, 2);
  ASSERT_FALSE(found.detections.empty());
  const Detection& best = found.detections.front();
  EXPECT_EQ(found.frame.utime, 123456);
  EXPECT_EQ(best.class_id, kind + 1);
  EXPECT_EQ(best.class_name, kind == 0 ? "stripes" : "rings");
  EXPECT_GT(box_iou(best.box_px, cv::Rect2f(cv::boundingRect(mask))), 0.5F);
  const Eigen::Vector3d centre = frame.camera.backproject(u, v, distance);
  EXPECT_LT((best.centre_camera.cast<double>() - centre).norm(), 0.025) << best.centre_camera.transpose();
  EXPECT_FALSE(best.rotations.empty());
}

TEST(Detector, FindsTheTaughtObjectsNearAndFar) {
  expect_tile(0, 159.5, 119.5, 0.7);
  expect_tile(1, 100, 80, 0.6);
  expect_tile(0, 220, 150, 1.0);
  expect_tile(1, 159.5, 119.5, 1.1);
}

/// Leaves depth in discs only, as a camera does that its own pattern dazzles; returns the share of `mask` that keeps
/// it.
double leave_depth_in_discs(int radius_px, const cv::Mat& mask, RgbdFrame& frame) {
  constexpr int kApart = 30;
  cv::Mat kept = cv::Mat::zeros(mask.size(), CV_8UC1);
  for (int y = kApart / 2; y < kept.rows; y += kApart) {
    for (int x = kApart / 2; x < kept.cols; x += kApart) cv::circle(kept, {x, y}, radius_px, 255, cv::FILLED);
  }
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN(), kept == 0);
  return static_cast<double>(cv::countNonZero(kept & mask)) / cv::countNonZero(mask);
}

TEST(Detector, FindsNearObjectsOfWhichLittleDepthIsMeasured) {
  for (const int kind : {0, 1}) {
    for (const int radius_px : {5, 8}) {
      RgbdFrame frame = toy::background(85);
      const cv::Mat mask = toy::put_tile(kind, 150, 120, 0.52, frame);
      const double kept = leave_depth_in_discs(radius_px, mask, frame);
      EXPECT_NEAR(kept, radius_px == 5 ? 0.09 : 0.22, 0.03);
      const Detections found = detect(frame, 2);
      ASSERT_FALSE(found.detections.empty()) << "tile " << kind << " with depth on " << kept;
      const Detection& best = found.detections.front();
      EXPECT_EQ(best.class_id, kind + 1);
      EXPECT_GT(box_iou(best.box_px, cv::Rect2f(cv::boundingRect(mask))), 0.5F);
      EXPECT_NEAR(best.centre_camera.z(), 0.52F, 0.025F);
    }
  }
}

TEST(Detector, AnotherOneFindsTheSameWithTheForestThatItTakes) {
  RgbdFrame frame = toy::background(77);
  toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  DetectionSettings settings;
  settings.evidence.threshold = 0.5F;
  Detector one(toy::forest(), settings);
  const Detections found = one.detect(frame);
  ASSERT_FALSE(found.detections.empty());
  const Detector another(std::move(one).take_groups(), settings);
  expect_same(another.detect(frame), found);
}

TEST(Detector, FindsNothingInAnEmptyRoom) {
  EXPECT_TRUE(detect(toy::background(78), 1).detections.empty());
}

TEST(Detector, CandidatesStandBehindWhatIsReportedAndChangeNothingOfIt) {
  RgbdFrame frame = toy::background(80);
  toy::put_tile(0, 90, 100, 0.7, frame);
  toy::put_tile(1, 230, 120, 0.8, frame);
  DetectionSettings settings;
  settings.leaves.first_trees = 1;
  settings.evidence.threshold = 0.5F;
  const Detections usual = Detector(toy::forest(), settings).detect(frame);
  settings.evidence.candidates_from = 0.0F;
  const Detections all = Detector(toy::forest(), settings).detect(frame);
  ASSERT_GT(all.detections.size(), usual.detections.size() + 1) << "weak maxima are there";
  for (std::size_t i = 0; i < all.detections.size(); ++i) {
    EXPECT_EQ(all.detections[i].reported, i < usual.detections.size());
    EXPECT_EQ(all.detections[i].reported, all.detections[i].score >= 0.5F);
    EXPECT_FALSE(all.detections[i].rotations.empty()) << "a pose starts from them";
  }
  Detections reported = all;
  reported.detections.resize(usual.detections.size());
  expect_same(reported, usual);
  settings.evidence.max_candidates = 1;
  const Detections few = Detector(toy::forest(), settings).detect(frame);
  ASSERT_EQ(few.detections.size(), usual.detections.size() + 1);
  EXPECT_EQ(few.detections.back().score, all.detections[usual.detections.size()].score) << "the strongest";
}

TEST(Detector, NothingIsFoundWhereThereIsNoDepth) {
  RgbdFrame frame = toy::background(79);
  toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(detect(frame, 1).detections.empty());
}

TEST(Detector, AnyNumberOfThreadsAndTheReferenceWayGiveTheSameDetections) {
  RgbdFrame frame = toy::background(80);
  toy::put_tile(0, 90, 100, 0.7, frame);
  toy::put_tile(1, 230, 120, 0.8, frame);
  DetectionSettings settings;
  settings.leaves.first_trees = 1;  // the toy forest has few
  settings.threads = 1;
  const Detections serial = Detector(toy::forest(), settings).detect(frame);
  ASSERT_GE(serial.detections.size(), 2U);
  for (const int threads : {2, 3, 7}) {
    settings.threads = threads;
    expect_same(Detector(toy::forest(), settings).detect(frame), serial);
  }
  expect_same(baseline::StudyDetector(toy::forest(), settings, baseline::Way::kReference).detect(frame), serial);
}

TEST(Detector, StagesAreTimedInTheOrderOfThePage) {
  RgbdFrame frame = toy::background(78);
  frame.stages = {{"capture.read", 5}};
  std::vector<std::string> names;
  for (const StageTime& time : detect(frame, 1).stages) names.push_back(time.stage);
  EXPECT_EQ(names, (std::vector<std::string>{"capture.read", "detect.resize", "detect.features", "detect.leaves",
                                             "detect.votes", "detect.evidence", "detect.suppression"}));
}

TEST(Detector, AWorkspaceLeavesNothingOfTheFramesBefore) {
  RgbdFrame frame = toy::background(82);
  toy::put_tile(1, 200, 120, 0.7, frame);
  RgbdFrame other = toy::background(83);
  toy::put_tile(0, 60, 60, 0.55, other);
  toy::put_tile(1, 250, 180, 1.1, other);
  DetectionSettings settings;
  settings.threads = 3;
  const Detector detector(toy::forest(), settings);
  DetectorWorkspace workspace;
  detector.detect(other, workspace);
  const Detections found = detector.detect(frame, workspace);
  ASSERT_FALSE(found.detections.empty());
  expect_same(found, detector.detect(frame));
}

TEST(Detector, AForestThatNeedsTheBaselineIsRefusedWithoutIt) {
  Forest forest = toy::forest();
  forest.features.handling = ScaleHandling::kScaleSpace;
  EXPECT_THROW(Detector(forest, {}), InputError);
  forest.features = toy::forest().features;
  forest.features.families |= kHonv;
  EXPECT_THROW(Detector(forest, {}), InputError);
}

TEST(Detector, FramesOfWrongSizesAreRefused) {
  RgbdFrame frame = toy::background(81);
  frame.depth = frame.depth(cv::Rect(0, 0, 100, 100));
  EXPECT_THROW(detect(frame, 1), InputError);
}

}  // namespace
}  // namespace houghstream
