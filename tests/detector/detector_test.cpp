#include "detector/detector.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/imgproc.hpp>

#include "detector/training/forest_trainer.hpp"
#include "pipeline/checks.hpp"
#include "same_detections.hpp"
#include "toy_data.hpp"

namespace houghstream {
namespace {

const Forest& toy_forest() {
  static const Forest forest = train_forest(toy::training_views(), toy::quick_profile(), [](const auto&) {});
  return forest;
}

Detections detect(const RgbdFrame& frame, int threads) {
  DetectionSettings settings;
  settings.threads = threads;
  settings.threshold = 0.5F;  // toys have learnt their scores from few pictures
  return Detector(toy_forest(), settings).detect(frame);
}

void expect_tile(int kind, double u, double v, double distance) {
  RgbdFrame frame = toy::room(77);
  frame.utime = 123456;
  const cv::Mat mask = toy::put_tile(kind, u, v, distance, frame);
  const Detections found = detect(frame, 2);
  ASSERT_FALSE(found.detections.empty());
  const Detection& best = found.detections.front();
  EXPECT_EQ(found.utime, 123456);
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

TEST(Detector, FindsNothingInAnEmptyRoom) {
  EXPECT_TRUE(detect(toy::room(78), 1).detections.empty());
}

TEST(Detector, NothingIsFoundWhereThereIsNoDepth) {
  RgbdFrame frame = toy::room(79);
  toy::put_tile(0, 159.5, 119.5, 0.7, frame);
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(detect(frame, 1).detections.empty());
}

TEST(Detector, AnyNumberOfThreadsAndTheReadableEngineGiveTheSameDetections) {
  RgbdFrame frame = toy::room(80);
  toy::put_tile(0, 90, 100, 0.7, frame);
  toy::put_tile(1, 230, 120, 0.8, frame);
  DetectionSettings settings;
  settings.first_trees = 1;  // the toy forest has few
  settings.threads = 1;
  const Detections serial = Detector(toy_forest(), settings).detect(frame);
  ASSERT_GE(serial.detections.size(), 2U);
  for (const int threads : {2, 3, 7}) {
    settings.threads = threads;
    expect_same(Detector(toy_forest(), settings).detect(frame), serial);
  }
  settings.readable = true;
  expect_same(Detector(toy_forest(), settings).detect(frame), serial);
}

TEST(Detector, FramesOfWrongSizesAreRefused) {
  RgbdFrame frame = toy::room(81);
  frame.depth = frame.depth(cv::Rect(0, 0, 100, 100));
  EXPECT_THROW(detect(frame, 1), InputError);
}

}  // namespace
}  // namespace houghstream
