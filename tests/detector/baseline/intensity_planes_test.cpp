#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "detector/baseline/reference_features.hpp"
#include "detector/features/feature_families.hpp"

namespace houghstream::baseline {
namespace {

enum IntensityPlane : std::size_t { kLightness, kA, kB, kIx, kIy, kIxx, kIyy, kFirstHog };

std::vector<int> at_centre(const cv::Mat& image) {
  std::vector<int> values;
  for (const cv::Mat& plane : intensity_planes(image)) {
    EXPECT_EQ(plane.type(), CV_8UC1);
    values.push_back(plane.at<std::uint8_t>(image.rows / 2, image.cols / 2));
  }
  EXPECT_EQ(values.size(), static_cast<std::size_t>(FeatureLayout().block(kIntensity).count));
  return values;
}

TEST(IntensityFeatures, AFlatImageHasColourAndNothingElse) {
  const std::vector<int> grey = at_centre(cv::Mat(15, 15, CV_8UC3, cv::Scalar(255, 255, 255)));
  EXPECT_EQ(grey[kLightness], 255);
  EXPECT_EQ(grey[kA], 128);
  EXPECT_EQ(grey[kB], 128);
  for (std::size_t p = kIx; p < grey.size(); ++p) EXPECT_EQ(grey[p], 0) << p;
}

TEST(IntensityFeatures, ColoursAreTakenAsBlueGreenRed) {
  const std::vector<int> blue = at_centre(cv::Mat(15, 15, CV_8UC3, cv::Scalar(255, 0, 0)));
  EXPECT_LT(blue[kB], 60);  // b runs from blue to yellow
  const std::vector<int> red = at_centre(cv::Mat(15, 15, CV_8UC3, cv::Scalar(0, 0, 255)));
  EXPECT_GT(red[kA], 200);
  EXPECT_GT(red[kB], 180);
}

TEST(IntensityFeatures, AVerticalEdgeHasASlopeAcrossOnly) {
  cv::Mat image(15, 16, CV_8UC3, cv::Scalar(40, 40, 40));
  image.colRange(8, 16).setTo(cv::Scalar(120, 120, 120));
  const std::vector<int> across = at_centre(image);
  EXPECT_GT(across[kIx], 100);
  EXPECT_EQ(across[kIy], 0);
  EXPECT_GT(across[kIxx], 50);
  EXPECT_EQ(across[kIyy], 0);
  EXPECT_GT(across[kFirstHog], 100);
  EXPECT_EQ(across[kFirstHog + 4], 0);
  cv::Mat rotated;
  cv::transpose(image, rotated);
  const std::vector<int> down = at_centre(rotated);
  EXPECT_EQ(down[kIx], 0);
  EXPECT_EQ(down[kIy], across[kIx]);
  EXPECT_EQ(down[kIyy], across[kIxx]);
  EXPECT_EQ(down[kFirstHog], 0);
  EXPECT_GT(down[kFirstHog + 4], 50);
}

TEST(IntensityFeatures, DarkToBrightAndBrightToDarkLookAlike) {
  cv::Mat image(15, 15, CV_8UC3, cv::Scalar(40, 40, 40));
  image.colRange(8, 15).setTo(cv::Scalar(120, 120, 120));
  cv::Mat mirrored;
  cv::flip(image, mirrored, 1);
  EXPECT_EQ(at_centre(image)[kIx], at_centre(mirrored)[kIx]);
  EXPECT_GT(at_centre(image)[kIx], 0);
}

}  // namespace
}  // namespace houghstream::baseline
