#include "tools/render/world/optics/photo.hpp"

#include <gtest/gtest.h>

namespace houghstream::world {
namespace {

TEST(Photo, ExposureBringsDarkAndBrightRoomsCloser) {
  const ColourCameraSettings settings;
  const auto mean = [&](double level) {
    return cv::mean(simulate_colour_camera(cv::Mat(60, 80, CV_32FC3, cv::Scalar::all(level)), settings, 1))[1];
  };
  EXPECT_GT(mean(0.05), 60.0);
  EXPECT_LT(mean(1.0), 190.0);
  EXPECT_LT(mean(0.05), mean(1.0));
}

TEST(Photo, NoiseFollowsTheSeed) {
  const cv::Mat grey(60, 80, CV_32FC3, cv::Scalar::all(0.2));
  const cv::Mat first = simulate_colour_camera(grey, {}, 1);
  EXPECT_EQ(cv::norm(first, simulate_colour_camera(grey, {}, 1), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(first, simulate_colour_camera(grey, {}, 2), cv::NORM_INF), 0.0);
  cv::Scalar mean;
  cv::Scalar deviation;
  ColourCameraSettings silent;
  silent.shot_noise = silent.read_noise = silent.vignetting = 0.0;
  cv::meanStdDev(simulate_colour_camera(grey, silent, 1), mean, deviation);
  EXPECT_EQ(deviation[0], 0.0);
}

/// Returns an edge between two colours that the camera usually sees.
cv::Mat two_colours() {
  cv::Mat photo(60, 80, CV_8UC3, cv::Scalar(60, 90, 140));
  photo.colRange(40, 80).setTo(cv::Scalar(120, 110, 100));
  return photo;
}

TEST(ColourResponse, AsItStandsChangesNothing) {
  EXPECT_EQ(cv::norm(apply_camera_response(two_colours(), {}), two_colours(), cv::NORM_INF), 0.0);
}

TEST(ColourResponse, EachStepDoesWhatItSays) {
  const cv::Mat photo = two_colours();
  const cv::Point middle(20, 30);
  const auto changed = [&](const ColourResponse& response) { return apply_camera_response(photo, response); };
  ColourResponse cool;
  cool.white_balance_bgr = {1.1, 1.0, 0.9};
  EXPECT_EQ(changed(cool).at<cv::Vec3b>(middle), cv::Vec3b(66, 90, 126));
  ColourResponse bright;
  bright.gamma = 0.5;
  EXPECT_EQ(changed(bright).at<cv::Vec3b>(middle)[0], 124) << "255 (60 / 255)^0.5";
  ColourResponse strong;
  strong.saturation = 2.0;
  const cv::Vec3b stronger = changed(strong).at<cv::Vec3b>(middle);
  EXPECT_EQ(stronger[2] - stronger[0], 2 * (140 - 60));
  ColourResponse dim_corners;
  dim_corners.further_vignetting = 0.5;
  EXPECT_EQ(changed(dim_corners).at<cv::Vec3b>(30, 40)[1], 110);
  EXPECT_NEAR(changed(dim_corners).at<cv::Vec3b>(0, 0)[1], 46, 1);
  ColourResponse sharp;
  sharp.sharpening = 0.6;
  const cv::Mat edge = changed(sharp);
  EXPECT_EQ(edge.at<cv::Vec3b>(middle), photo.at<cv::Vec3b>(middle));
  EXPECT_LT(edge.at<cv::Vec3b>(30, 39)[0], 60) << "an edge overshoots on both sides";
  EXPECT_GT(edge.at<cv::Vec3b>(30, 40)[0], 120);
}

TEST(ColourResponse, TheOtherCameraIsCoolerBrighterAndStronger) {
  const cv::Mat photo = two_colours();
  const cv::Mat other = apply_camera_response(photo, other_colour_camera());
  const cv::Scalar before = cv::mean(photo);
  const cv::Scalar after = cv::mean(other);
  EXPECT_GT(after[0] / after[2], 1.1 * before[0] / before[2]);
  EXPECT_GT(after[0] + after[1] + after[2], before[0] + before[1] + before[2] + 15.0);
}

}  // namespace
}  // namespace houghstream::world
