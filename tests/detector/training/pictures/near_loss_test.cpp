#include "detector/training/pictures/near_loss.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace houghstream {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

/// Near on the left, far on the right, unknown at the bottom.
cv::Mat half_near() {
  cv::Mat depth(kHeight, kWidth, CV_32FC1, cv::Scalar(1.5));
  depth.colRange(0, kWidth / 2) = 0.5;
  depth.rowRange(kHeight - 20, kHeight) = std::numeric_limits<float>::quiet_NaN();
  return depth;
}

int measured(const cv::Mat& depth) {
  return cv::countNonZero(depth == depth);
}

TEST(NearLoss, LeavesTheShareOfWhatIsNearAndAllThatIsFar) {
  const int near_px = kWidth / 2 * (kHeight - 20);
  for (const double kept : {0.05, 0.3, 1.0}) {
    cv::Mat depth = half_near();
    Random random(3);
    lose_near_depth(0.8, kept, depth, random);
    EXPECT_NEAR(measured(depth.colRange(0, kWidth / 2)), kept * near_px, 2.0);
    EXPECT_EQ(measured(depth.colRange(kWidth / 2, kWidth)), near_px);
    EXPECT_EQ(cv::countNonZero(depth == 0.5F) + cv::countNonZero(depth == 1.5F), measured(depth)) << "values stay";
  }
}

TEST(NearLoss, WhatStaysLiesInPatches) {
  cv::Mat depth(kHeight, kWidth, CV_32FC1, cv::Scalar(0.5));
  Random random(4);
  lose_near_depth(0.8, 0.25, depth, random);
  int kept = 0;
  int with_right_neighbour = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x + 1 < kWidth; ++x) {
      if (!(depth.at<float>(y, x) > 0.0F)) continue;
      ++kept;
      with_right_neighbour += depth.at<float>(y, x + 1) > 0.0F ? 1 : 0;
    }
  }
  EXPECT_GT(with_right_neighbour, 0.7 * kept) << "single pixels would have a quarter";
}

TEST(NearLoss, WithoutAnythingNearAllStays) {
  cv::Mat depth = half_near();
  Random random(5);
  lose_near_depth(0.2, 0.05, depth, random);
  EXPECT_EQ(measured(depth), measured(half_near()));
}

TEST(NearLoss, TheSameSeedLosesTheSame) {
  cv::Mat first = half_near();
  cv::Mat second = half_near();
  Random random(6);
  lose_near_depth(0.8, 0.2, first, random);
  Random again(6);
  lose_near_depth(0.8, 0.2, second, again);
  EXPECT_EQ(cv::countNonZero((first == first) != (second == second)), 0);
}

}  // namespace
}  // namespace houghstream
