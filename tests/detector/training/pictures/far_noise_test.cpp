#include "detector/training/pictures/far_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "detector/training/pictures/composites.hpp"

namespace houghstream {
namespace {

cv::Mat noisy(double ratio) {
  cv::Mat depth(240, 320, CV_32FC1, cv::Scalar(0.7));
  Random random(3);
  add_far_noise(0.7, ratio, depth, random);
  return depth;
}

double deviation(const cv::Mat& values) {
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(values, mean, sigma);
  EXPECT_NEAR(mean[0], 0.7, 0.001);
  return sigma[0];
}

/// Of pixels side by side, over that of all pixels: 1.41 where they know nothing of each other.
double contrast(const cv::Mat& values) {
  cv::Mat difference = values.colRange(1, values.cols) - values.colRange(0, values.cols - 1) + 0.7;
  return deviation(difference) / deviation(values);
}

TEST(FarNoise, AddsWhatTheLargerDistanceHasMore) {
  for (const double ratio : {1.5, 2.3}) {
    const double expected = std::sqrt(std::pow(axial_noise(0.7 * ratio), 2) - std::pow(axial_noise(0.7), 2));
    EXPECT_NEAR(deviation(noisy(ratio)), expected, 0.25 * expected) << ratio;  // interpolation takes some of it
  }
}

TEST(FarNoise, IsAsCoarseAsThePicturesOfThatDistanceEnlarged) {
  EXPECT_LT(contrast(noisy(1.2)), 0.9);
  EXPECT_LT(contrast(noisy(2.4)), 0.6 * contrast(noisy(1.2)));
}

TEST(FarNoise, NothingIsAddedAtTheOwnDistanceAndNothingMissingIsMadeUp) {
  EXPECT_EQ(cv::norm(noisy(1.0), cv::Mat(240, 320, CV_32FC1, cv::Scalar(0.7)), cv::NORM_INF), 0.0);
  cv::Mat depth(20, 30, CV_32FC1, cv::Scalar(0.7));
  depth.at<float>(4, 5) = std::numeric_limits<float>::quiet_NaN();
  Random random(3);
  add_far_noise(0.7, 2.0, depth, random);
  EXPECT_TRUE(std::isnan(depth.at<float>(4, 5)));
  EXPECT_FALSE(std::isnan(depth.at<float>(4, 6)));
}

}  // namespace
}  // namespace houghstream
