#include "tools/evaluate/reliability_image.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

int coloured_pixels(const cv::Mat& image) {
  std::vector<cv::Mat> channels;
  cv::split(image, channels);
  return cv::countNonZero(channels[0] != channels[2]);
}

TEST(ReliabilityImage, BarsAreAsHighAsWhatIsTrue) {
  const Calibration nothing = calibrate({}, 0);
  const cv::Mat empty = reliability_image(nothing, nothing);
  EXPECT_EQ(coloured_pixels(empty), 0);
  const auto pixels = [&](double fraction) {
    std::vector<Prediction> statements;
    statements.reserve(20);
    for (int i = 0; i < 20; ++i) statements.push_back({0.95, i < 20 * fraction});
    const cv::Mat image = reliability_image(nothing, calibrate(statements, 20));
    const int half = image.cols / 2;
    EXPECT_EQ(coloured_pixels(image.colRange(0, half)), 0) << "quality stands on the right";
    return coloured_pixels(image.colRange(half, image.cols));
  };
  const int half = pixels(0.5);
  EXPECT_GT(half, 1000);
  EXPECT_NEAR(pixels(1.0), 2 * half, 0.25 * half);
}

}  // namespace
}  // namespace houghstream
