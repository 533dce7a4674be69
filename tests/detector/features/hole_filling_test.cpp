#include "detector/features/hole_filling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/no_value.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

/// Returns depth that differs in every pixel, so that borrowed values show their origin.
cv::Mat numbered_depth(cv::Size size) {
  cv::Mat depth(size, CV_32FC1);
  for (int i = 0; i < size.area(); ++i) depth.at<float>(i / size.width, i % size.width) = static_cast<float>(i + 1);
  return depth;
}

/// Returns the distance from each pixel to the one it has borrowed from; -1 where it is still a hole.
cv::Mat borrowed_from(const cv::Mat& depth) {
  cv::Mat distances(depth.size(), CV_32FC1);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const float value = depth.at<float>(y, x);
      const int from = std::isnan(value) ? -1 : static_cast<int>(value) - 1;
      const int dx = from % depth.cols - x;
      const int dy = from / depth.cols - y;
      distances.at<float>(y, x) = from < 0 ? -1.0F : std::hypot(static_cast<float>(dx), static_cast<float>(dy));
    }
  }
  return distances;
}

TEST(HoleFilling, HolesBorrowFromTheNearestPixelOrOneHardlyFartherAway) {
  Random random(51);
  for (const double fraction : {0.02, 0.5, 0.98}) {
    cv::Mat depth = numbered_depth({90, 70});
    cv::Mat missing = cv::Mat::zeros(depth.size(), CV_8UC1);
    for (int i = 0; i < 90 * 70; ++i) missing.at<std::uint8_t>(i / 90, i % 90) = random.uniform() < fraction ? 1 : 0;
    missing(cv::Rect(20, 20, 30, 25)).setTo(1);
    depth.setTo(kNoValue, missing);
    cv::Mat nearest;
    cv::distanceTransform(missing, nearest, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    fill_holes(depth, {1000.0F, 0.0F});
    const cv::Mat found = borrowed_from(depth);
    for (int i = 0; i < 90 * 70; ++i) {
      const float expected = nearest.at<float>(i / 90, i % 90);
      ASSERT_GE(found.at<float>(i / 90, i % 90), expected - 0.001F) << i;
      ASSERT_LE(found.at<float>(i / 90, i % 90), expected * 1.05F + 0.001F) << i;
    }
  }
}

TEST(HoleFilling, WhatIsFartherAwayThanTheLimitStaysAHole) {
  cv::Mat depth = numbered_depth({40, 1});
  depth.colRange(5, 40).setTo(kNoValue);
  fill_holes(depth, {10.0F, 0.0F});
  EXPECT_EQ(depth.at<float>(0, 14), 5.0F);
  EXPECT_TRUE(std::isnan(depth.at<float>(0, 15)));
}

/// Returns a near surface on the left, a far one on the right, between them columns 10 to 89 without depth.
cv::Mat gap(float near, float far) {
  cv::Mat depth(3, 100, CV_32FC1, cv::Scalar(kNoValue));
  depth.colRange(0, 10).setTo(near);
  depth.colRange(90, 100).setTo(far);
  return depth;
}

TEST(HoleFilling, NearSurfacesLendFarther) {
  cv::Mat depth = gap(0.5F, 2.0F);
  fill_holes(depth, {1000.0F, 1.0F});
  // There are 81 pixels in all, divided as 2 m to 0.5 m.
  EXPECT_EQ(depth.at<float>(1, 9 + 64), 0.5F);
  EXPECT_EQ(depth.at<float>(1, 9 + 66), 2.0F);
  cv::Mat in_pixels = gap(0.5F, 2.0F);
  fill_holes(in_pixels, {1000.0F, 0.0F});
  EXPECT_EQ(in_pixels.at<float>(1, 9 + 40), 0.5F);
  EXPECT_EQ(in_pixels.at<float>(1, 9 + 41), 2.0F);
}

TEST(HoleFilling, TheReachInMetresCountsWhereItIsMorePixels) {
  cv::Mat depth = gap(0.5F, 2.0F);
  fill_holes(depth, {10.0F, 15.0F});  // 30 pixels from 0.5 m; from 2 m 7.5, so 10
  EXPECT_EQ(depth.at<float>(1, 9 + 30), 0.5F);
  EXPECT_TRUE(std::isnan(depth.at<float>(1, 9 + 31)));
  EXPECT_TRUE(std::isnan(depth.at<float>(1, 90 - 11)));
  EXPECT_EQ(depth.at<float>(1, 90 - 10), 2.0F);
}

TEST(HoleFilling, WithoutHolesAndWithoutDepthNothingChanges) {
  cv::Mat full = numbered_depth({9, 7});
  fill_holes(full, {5.0F, 0.0F});
  EXPECT_EQ(cv::countNonZero(full != numbered_depth({9, 7})), 0);
  cv::Mat empty(7, 9, CV_32FC1, cv::Scalar(kNoValue));
  fill_holes(empty, {5.0F, 0.0F});
  EXPECT_EQ(cv::countNonZero(empty == empty), 0);
}

}  // namespace
}  // namespace houghstream
