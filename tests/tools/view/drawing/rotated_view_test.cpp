#include "tools/view/drawing/rotated_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/base/no_value.hpp"

namespace houghstream::view {
namespace {

const cv::Vec3b kRed(0, 0, 250);
const cv::Vec3b kWall(120, 120, 120);

/// Returns a grey wall at 2 m, and before its middle a red square of 21 pixels at 1.5 m.
RgbdFrame wall_and_square() {
  RgbdFrame frame;
  frame.camera = Camera{160, 120, 130.0, 130.0, 79.5, 59.5};
  frame.colour = cv::Mat(120, 160, CV_8UC3, cv::Scalar(kWall));
  frame.depth = cv::Mat(120, 160, CV_32FC1, cv::Scalar(2.0));
  const cv::Rect square(70, 50, 21, 21);
  frame.colour(square).setTo(cv::Scalar(kRed));
  frame.depth(square).setTo(1.5);
  return frame;
}

cv::Point2d centre_of(const cv::Mat& image, const cv::Vec3b& colour) {
  cv::Mat mask;
  cv::inRange(image, cv::Scalar(colour), cv::Scalar(colour), mask);
  std::vector<cv::Point> pixels;
  cv::findNonZero(mask, pixels);
  cv::Point2d sum;
  for (const cv::Point& pixel : pixels) sum += cv::Point2d(pixel);
  return sum / static_cast<double>(pixels.size());
}

TEST(TurnedView, LooksFromTheRightAndFromAboveAtTheMiddleOfWhatWasMeasured) {
  const Eigen::Isometry3d T = rotated_camera(wall_and_square().depth);
  const Eigen::Vector3d pivot(0.0, 0.0, 2.0);
  EXPECT_TRUE((T * pivot).isApprox(pivot, 1e-6));
  const Eigen::Vector3d eye = T.inverse() * Eigen::Vector3d::Zero();
  EXPECT_GT(eye.x(), 0.5);
  EXPECT_LT(eye.y(), -0.5);
}

TEST(TurnedView, PointsAreWhereTheyAreSeenFromThere) {
  const RgbdFrame frame = wall_and_square();
  const cv::Mat image = draw_rotated_view(frame, std::nullopt, {});
  ASSERT_EQ(image.size(), frame.colour.size());
  const Eigen::Vector3d middle = frame.camera.backproject(80.0, 60.0, 1.5);
  const Eigen::Vector2d expected = frame.camera.project(rotated_camera(frame.depth) * middle);
  const cv::Point2d seen = centre_of(image, kRed);
  EXPECT_NEAR(seen.x, expected.x(), 1.0);
  EXPECT_NEAR(seen.y, expected.y(), 1.0);
  EXPECT_LT(seen.x, 75.0) << "what is near moves to the left";
  EXPECT_GT(seen.y, 65.0) << "and down";
}

TEST(TurnedView, WhatIsNearHidesWhatIsFar) {
  RgbdFrame frame = wall_and_square();
  const Eigen::Vector2d at = frame.camera.project(rotated_camera(frame.depth) * frame.camera.backproject(80, 60, 1.5));
  const cv::Mat image = draw_rotated_view(frame, std::nullopt, {});
  EXPECT_EQ(image.at<cv::Vec3b>(static_cast<int>(at.y()), static_cast<int>(at.x())), kRed);
}

TEST(TurnedView, WhereNothingWasMeasuredThereIsNothing) {
  RgbdFrame frame = wall_and_square();
  frame.depth.setTo(kNoValue);
  const cv::Mat image = draw_rotated_view(frame, std::nullopt, {});
  EXPECT_EQ(cv::norm(image, cv::Mat(image.size(), CV_8UC3, cv::Scalar(image.at<cv::Vec3b>(0, 0)))), 0.0);
}

TEST(TurnedView, PosesAreTurnedWithTheirPoints) {
  const RgbdFrame frame = wall_and_square();
  ObjectPoses poses;
  poses.poses.resize(2);  // the second has no pose
  poses.poses[0].class_id = 1;
  poses.poses[0].T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(frame.camera.backproject(80, 60, 1.5)));
  const cv::Mat without = draw_rotated_view(frame, std::nullopt, {});
  const cv::Mat with_axes = draw_rotated_view(frame, poses, {});
  cv::Mat changed;
  cv::absdiff(with_axes, without, changed);
  std::vector<cv::Point> pixels;
  cv::findNonZero(changed.reshape(1, changed.rows), pixels);
  ASSERT_FALSE(pixels.empty());
  const Eigen::Vector2d at =
      frame.camera.project(rotated_camera(frame.depth) * poses.poses[0].T_camera_object->translation());
  for (const cv::Point& pixel : pixels) {
    EXPECT_LT(std::hypot(std::floor(pixel.x / 3.0) - at.x(), pixel.y - at.y()), 15.0) << "axes of 5 cm";
  }
}

}  // namespace
}  // namespace houghstream::view
