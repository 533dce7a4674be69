#include "detector/training/augmentation/dehazing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace houghstream::training {
namespace {

/// Returns a grey ramp from `dark` to `bright` with some red in it.
cv::Mat ramp(int dark, int bright) {
  constexpr int kLast = 99;
  cv::Mat out(20, kLast + 1, CV_8UC3);
  for (int y = 0; y < out.rows; ++y) {
    for (int x = 0; x <= kLast; ++x) {
      const int grey = dark + (bright - dark) * x / kLast;
      out.at<cv::Vec3b>(y, x) = cv::Vec3b(cv::saturate_cast<std::uint8_t>(grey), cv::saturate_cast<std::uint8_t>(grey),
                                          cv::saturate_cast<std::uint8_t>(grey + 10));
    }
  }
  return out;
}

double contrast(const cv::Mat& colour) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(colour, mean, deviation);
  return deviation[0];
}

TEST(ClearHaze, GivesAHazyObjectMoreContrastAndNeverMuchLess) {
  const cv::Mat mask(20, 100, CV_8UC1, cv::Scalar(255));
  double maximum = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    cv::Mat hazy = ramp(60, 140);
    Random random(seed);
    remove_haze(mask, hazy, random);
    EXPECT_GT(contrast(hazy), 0.95 * contrast(ramp(60, 140)));
    maximum = std::max(maximum, contrast(hazy));
  }
  EXPECT_GT(maximum, 1.8 * contrast(ramp(60, 140)));
}

TEST(ClearHaze, LeavesAClearObjectsRangeNearlyAsItIs) {
  const cv::Mat mask(20, 100, CV_8UC1, cv::Scalar(255));
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    cv::Mat clear = ramp(0, 245);
    Random random(seed);
    remove_haze(mask, clear, random);
    EXPECT_NEAR(contrast(clear), contrast(ramp(0, 245)), 0.1 * contrast(ramp(0, 245)));
  }
}

/// Dark on the left, bright on the right, the step as soft as a lens makes it.
cv::Mat soft_step(double sigma) {
  cv::Mat step(20, 60, CV_8UC3, cv::Scalar::all(60));
  step.colRange(30, 60).setTo(cv::Scalar::all(180));
  if (sigma > 0.0) cv::GaussianBlur(step, step, cv::Size(), sigma);
  return step;
}

int steepest_step(const cv::Mat& colour) {
  int maximum = 0;
  for (int x = 1; x < colour.cols; ++x) {
    maximum = std::max(maximum, colour.at<cv::Vec3b>(10, x)[1] - colour.at<cv::Vec3b>(10, x - 1)[1]);
  }
  return maximum;
}

TEST(Sharpened, ASoftEdgeGetsSteeperWithSharpness) {
  const int as_taught = steepest_step(soft_step(1.5));
  const int half = steepest_step(apply_unsharp_mask(soft_step(1.5), 0.75));
  const int full = steepest_step(apply_unsharp_mask(soft_step(1.5), 1.5));
  EXPECT_GT(half, 1.1 * as_taught);
  EXPECT_GT(full, 1.1 * half);
  EXPECT_LT(full, steepest_step(soft_step(0.0)));
}

TEST(Sharpened, WhatIsEvenStaysAndZeroChangesNothing) {
  const cv::Mat even(20, 20, CV_8UC3, cv::Scalar(10, 120, 250));
  EXPECT_EQ(cv::norm(apply_unsharp_mask(even, 1.5), even, cv::NORM_INF), 0.0);
  const cv::Mat step = soft_step(1.0);
  EXPECT_EQ(apply_unsharp_mask(step, 0.0).data, step.data);
}

}  // namespace
}  // namespace houghstream::training
