#include "tools/studies/hough/hough_panels.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

constexpr int kCaption = 28;
constexpr int kGap = 4;
const cv::Size kFrame(320, 240);
const cv::Scalar kGreen(0, 255, 0);

cv::Mat grey_image() {
  return cv::Mat(kFrame, CV_8UC3, cv::Scalar(90, 90, 90));
}

HoughPanel panel_of(const std::string& title, cv::Point at, float value) {
  HoughPanel panel{title, cv::Mat::zeros(kFrame, CV_32FC1), {}};
  panel.votes.at<float>(at) = value;
  return panel;
}

int brightness(const cv::Mat& image, int x, int y) {
  const auto& pixel = image.at<cv::Vec3b>(y, x);
  return pixel[0] + pixel[1] + pixel[2];
}

TEST(HoughPanels, PanelsShareOneScale) {
  const cv::Point at(100, 150);
  const cv::Mat image = draw_hough_panels(grey_image(), {}, {panel_of("bowl", at, 0.8F), panel_of("mug", at, 0.2F)});
  ASSERT_EQ(image.size(), cv::Size(2 * 320 + kGap, 2 * (240 + kCaption) + kGap));
  const int bowl = brightness(image, 320 + kGap + at.x, kCaption + at.y);
  const int mug = brightness(image, at.x, 240 + 2 * kCaption + kGap + at.y);
  EXPECT_GT(bowl, 500);
  EXPECT_GT(bowl, 2 * mug);
  EXPECT_EQ(brightness(image, 320 + kGap + at.x + 5, kCaption + at.y), 3 * 32);  // no votes: the frame, darkened
}

TEST(HoughPanels, BoxesLieWhereTheyShould) {
  HoughPanel panel = panel_of("bowl", {10, 10}, 0.0F);  // nothing voted at all
  panel.found.push_back({{50, 60, 40, 30}, "0.70", kGreen});
  const cv::Mat image = draw_hough_panels(grey_image(), {{{20, 30, 40, 50}, "bowl", kGreen}}, {panel});
  const cv::Vec3b green(0, 255, 0);
  EXPECT_EQ(image.at<cv::Vec3b>(kCaption + 50, 20), green);
  EXPECT_EQ(image.at<cv::Vec3b>(kCaption + 75, 320 + kGap + 50), green);
}

TEST(HoughPanels, VotesOfAnotherSizeAreRefused) {
  HoughPanel panel{"bowl", cv::Mat::zeros(120, 160, CV_32FC1), {}};
  EXPECT_THROW(draw_hough_panels(grey_image(), {}, {panel}), InputError);
}

}  // namespace
}  // namespace houghstream
