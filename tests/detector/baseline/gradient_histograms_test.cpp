#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "detector/baseline/reference_features.hpp"
#include "detector/features/feature_families.hpp"

namespace houghstream::baseline {
namespace {

/// Histograms of a constant gradient: blurring changes nothing.
std::vector<int> histogram_of(float dx, float dy) {
  const cv::Mat gx(9, 9, CV_32FC1, cv::Scalar(dx));
  const cv::Mat gy(9, 9, CV_32FC1, cv::Scalar(dy));
  std::vector<int> bins;
  for (const cv::Mat& plane : gradient_histograms(gx, gy, 10.0F)) {
    EXPECT_EQ(plane.type(), CV_8UC1);
    bins.push_back(plane.at<std::uint8_t>(4, 4));
  }
  return bins;
}

TEST(Hog, AVerticalEdgeFillsTheFirstBinAlone) {
  EXPECT_EQ(histogram_of(10.0F, 0.0F), (std::vector<int>{100, 0, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(Hog, AHorizontalEdgeIsSharedByTheTwoMiddleBins) {
  EXPECT_EQ(histogram_of(0.0F, 10.0F), (std::vector<int>{0, 0, 0, 0, 50, 50, 0, 0, 0}));
}

TEST(Hog, OppositeGradientsAreTheSameOrientation) {
  EXPECT_EQ(histogram_of(3.0F, 7.0F), histogram_of(-3.0F, -7.0F));
  EXPECT_NE(histogram_of(3.0F, 7.0F), histogram_of(-3.0F, 7.0F));
}

TEST(Hog, DiagonalsLieWhereTheirAngleSays) {
  const std::vector<int> rising = histogram_of(5.0F, 5.0F);  // 45 degrees: bin 2.25
  EXPECT_NEAR(rising[2], 53, 2);
  EXPECT_NEAR(rising[3], 18, 2);
  const std::vector<int> falling = histogram_of(5.0F, -5.0F);  // 135 degrees: bin 6.75
  EXPECT_NEAR(falling[6], 18, 2);
  EXPECT_NEAR(falling[7], 53, 2);
}

TEST(Hog, TheLastBinIsTheFirstOnesNeighbour) {
  const std::vector<int> bins = histogram_of(10.0F, -1.7633F);  // 170 degrees: bin 8.5
  EXPECT_NEAR(bins[8], 51, 2);
  EXPECT_NEAR(bins[0], 51, 2);
}

TEST(Hog, FlatImagesHaveEmptyHistograms) {
  EXPECT_EQ(histogram_of(0.0F, 0.0F), std::vector<int>(9, 0));
}

TEST(Hog, OneGradientReachesTwoPixelsFar) {
  cv::Mat dx = cv::Mat::zeros(11, 11, CV_32FC1);
  dx.at<float>(5, 5) = 20.0F;
  const cv::Mat plane = gradient_histograms(dx, cv::Mat::zeros(11, 11, CV_32FC1), 10.0F)[0];
  EXPECT_GT(plane.at<std::uint8_t>(5, 5), plane.at<std::uint8_t>(5, 7));
  EXPECT_GT(plane.at<std::uint8_t>(7, 7), 0);
  EXPECT_EQ(plane.at<std::uint8_t>(5, 8), 0);
  EXPECT_NEAR(cv::sum(plane)[0], 200.0, 12.0);  // the window's weights sum to 1
}

}  // namespace
}  // namespace houghstream::baseline
