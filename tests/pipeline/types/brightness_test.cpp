#include "pipeline/types/brightness.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

/// Stripes of two greys.
cv::Mat striped(int dark, int bright) {
  cv::Mat image(48, 64, CV_8UC3);
  for (int y = 0; y < image.rows; ++y) image.row(y).setTo(cv::Scalar::all(y / 4 % 2 == 0 ? dark : bright));
  return image;
}

TEST(Tone, AnyImageIsInTheRangeOfAll) {
  cv::Mat image = striped(0, 255);
  const cv::Mat before = image.clone();
  const AffineBrightness curve = fit_affine_brightness(image, {});
  EXPECT_FALSE(curve.changes());
  apply_affine_brightness(curve, image, image);
  EXPECT_EQ(cv::norm(image, before, cv::NORM_INF), 0.0);
}

TEST(Tone, WhatIsInTheRangeStays) {
  EXPECT_FALSE(fit_affine_brightness(striped(80, 140), {100.0F, 130.0F, 50.0F}).changes());
}

TEST(Tone, ContrastIsFlattenedAboutTheMean) {
  cv::Mat image = striped(40, 180);  // 110, deviation 70
  const AffineBrightness curve = fit_affine_brightness(image, {100.0F, 130.0F, 50.0F});
  EXPECT_NEAR(curve.gain, 50.0F / 70.0F, 1e-5);
  apply_affine_brightness(curve, image, image);
  EXPECT_NEAR(image.at<cv::Vec3b>(0, 0)[1], 60, 1);
  EXPECT_NEAR(image.at<cv::Vec3b>(4, 0)[1], 160, 1);
}

TEST(Tone, ContrastIsFlattenedToNoLessThanSixTenths) {
  EXPECT_NEAR(fit_affine_brightness(striped(0, 255), {0.0F, 255.0F, 20.0F}).gain, 0.6F, 1e-6);
}

TEST(Tone, DarkAndBrightImagesComeIntoTheRange) {
  cv::Mat dark = striped(20, 60);
  apply_affine_brightness(fit_affine_brightness(dark, {100.0F, 130.0F, 50.0F}), dark, dark);
  EXPECT_NEAR(cv::mean(dark)[0], 100.0, 1.0);
  cv::Mat bright = striped(190, 210);
  apply_affine_brightness(fit_affine_brightness(bright, {100.0F, 130.0F, 50.0F}), bright, bright);
  EXPECT_NEAR(cv::mean(bright)[2], 130.0, 1.0);
}

TEST(Tone, AnImageOfOnePixelHasATone) {
  cv::Mat image(1, 1, CV_8UC3, cv::Scalar(255, 0, 0));
  EXPECT_NEAR(fit_affine_brightness(image, {100.0F, 130.0F, 50.0F}).offset, 100.0F - 29.07F, 0.01F);
}

}  // namespace
}  // namespace houghstream
