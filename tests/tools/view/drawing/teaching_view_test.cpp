#include "tools/view/drawing/teaching_view.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/test_frame.hpp"
#include "tools/view/drawing/frame_view.hpp"

namespace houghstream::view {
namespace {

const cv::Vec3b kSeen(110, 200, 60);

/// Returns sixty directions, those with positive x seen.
Teaching half_seen() {
  Teaching mug;
  mug.frame = {"", 1000};
  mug.name = "mug";
  mug.state = TeachingState::kTracking;
  mug.message = "seen from 30 of 60 directions; from behind nothing yet";
  mug.progress = 0.5F;
  for (int i = 0; i < 60; ++i) {
    const float z = (static_cast<float>(i) + 0.5F) / 30.0F - 1.0F;
    const float angle = 2.39996F * static_cast<float>(i);  // the golden angle
    const float r = std::sqrt(1.0F - z * z);
    mug.directions.push_back({{r * std::cos(angle), r * std::sin(angle), z}, std::cos(angle) > 0.0F});
  }
  return mug;
}

int count_colour(const cv::Mat& image, const cv::Vec3b& colour) {
  int count = 0;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) count += image.at<cv::Vec3b>(y, x) == colour ? 1 : 0;
  }
  return count;
}

TEST(TeachingView, TheSphereFillsWhereItWasSeen) {
  Teaching mug = half_seen();
  const auto filled = [&](const Eigen::Matrix3f& R_view_object) {
    cv::Mat image(100, 100, CV_8UC3, cv::Scalar());
    draw_sphere(image, {0, 0, 100, 100}, mug.directions, R_view_object);
    return count_colour(image, kSeen);
  };
  // The view's z points away from the camera: from positive x the object's x points towards the viewer.
  Eigen::Matrix3f from_x;
  from_x << 0, 1, 0, 0, 0, -1, -1, 0, 0;
  Eigen::Matrix3f from_minus_x;
  from_minus_x << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  EXPECT_GT(filled(from_x), 1000);
  EXPECT_EQ(filled(from_minus_x), 0);
  for (ViewDirection& direction : mug.directions) direction.seen = true;
  EXPECT_NEAR(filled(from_minus_x), filled(from_x), 0.2 * filled(from_x));
}

TEST(TeachingView, BoxSphereWordsAndProgressAreDrawn) {
  RgbdFrame frame = make_test_frame(1000, 640, 480);
  Teaching mug = half_seen();
  const auto changed = [&](const cv::Rect& area) {
    cv::Mat image = frame.colour.clone();
    draw_teaching(image, mug, frame);
    cv::Mat difference;
    cv::absdiff(image(area), frame.colour(area), difference);
    return cv::countNonZero(difference.reshape(1));
  };
  const cv::Rect middle(200, 160, 200, 160);
  EXPECT_EQ(changed(middle), 0);
  mug.box_px = cv::Rect2f(250, 200, 80, 60);
  EXPECT_GT(changed(middle), 300) << "its box";
  mug.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.8));
  const int with_axes = changed(middle);
  mug.T_camera_object.reset();
  EXPECT_GT(with_axes, changed(middle)) << "its axes";
  mug.frame.utime += 1'000'000;
  EXPECT_EQ(changed(middle), 0) << "but not over a frame of another time";
  mug.frame = {"OTHER_CAMERA", 1000};
  EXPECT_EQ(changed(middle), 0) << "or of another camera";
  EXPECT_GT(changed({400, 0, 240, 140}), 1000) << "the sphere";
  cv::Mat image = frame.colour.clone();
  draw_teaching(image, mug, frame);
  EXPECT_EQ(count_colour(image.row(479), kSeen), 320) << "half of the work";
}

TEST(TeachingView, OfASmallImageNothingIsDrawnOutside) {
  const RgbdFrame frame = make_test_frame(1000, 64, 48);
  cv::Mat image = frame.colour.clone();
  Teaching mug = half_seen();
  mug.box_px = cv::Rect2f(-20, -20, 500, 500);
  EXPECT_NO_THROW(draw_teaching(image, mug, frame));
}

TEST(TeachingView, AFrameIsShownWithTheTeachingThatGoesOn) {
  ViewedFrame viewed;
  viewed.frame = make_test_frame(1000, 640, 480);
  viewed.detections.frame = viewed.frame.id;
  StreamView stream;
  const cv::Mat without = draw_frame_view(viewed, {}, {}, stream);
  stream.state.teaching = half_seen();
  const cv::Mat with = draw_frame_view(viewed, {}, {}, stream);
  EXPECT_GT(cv::norm(with, without, cv::NORM_L1), 0.0);
}

}  // namespace
}  // namespace houghstream::view
