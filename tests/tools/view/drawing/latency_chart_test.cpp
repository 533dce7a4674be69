#include "tools/view/drawing/latency_chart.hpp"

#include <gtest/gtest.h>

namespace houghstream::view {
namespace {

const cv::Rect kArea(10, 20, 90, 50);

int count(const cv::Mat& image, const cv::Scalar& colour) {
  cv::Mat same;
  cv::inRange(image, colour, colour, same);
  return cv::countNonZero(same);
}

cv::Mat blank() {
  return cv::Mat(80, 120, CV_8UC3, cv::Scalar::all(7));
}

TEST(LatencyChart, NeighbouringStagesLookDifferent) {
  for (std::size_t i = 0; i + 1 < 12; ++i) EXPECT_GT(cv::norm(stage_colour(i) - stage_colour(i + 1)), 40.0) << i;
}

TEST(LatencyChart, AFrameIsAsHighAsItsTime) {
  cv::Mat image = blank();
  // The scale is 100 ms: 40 ms are 20 rows of 50, 20 ms are 10, two pixels wide.
  draw_latency_chart(image, kArea, {{{{"a", 40000}, {"b", 20000}}, 90.0}});
  EXPECT_EQ(count(image, stage_colour(0)), 2 * 20);
  EXPECT_EQ(count(image, stage_colour(1)), 2 * 10);
  EXPECT_EQ(image.at<cv::Vec3b>(20 + 5, 10 + 87), cv::Vec3b(255, 255, 255));  // 90 ms
}

TEST(LatencyChart, ASingleSlowFrameIsMarkedAndDoesNotFlattenTheOthers) {
  LatencyHistory history(20, {{{"a", 40000}}, std::nullopt});
  const cv::Rect wide(10, 20, 390, 50);  // the words above the columns leave its right side free
  cv::Mat even(80, 420, CV_8UC3, cv::Scalar::all(7));
  cv::Mat image = even.clone();
  draw_latency_chart(even, wide, history);
  history[15].stages[0].duration_us = 5'000'000;
  draw_latency_chart(image, wide, history);
  // The scale is 50 ms: 40 ms are 40 rows of 50, two pixels wide.
  const int x = 10 + 390 - 3 * 5;
  EXPECT_EQ(image.at<cv::Vec3b>(20 + 11, x + 3), even.at<cv::Vec3b>(20 + 11, x + 3));
  EXPECT_EQ(count(image(cv::Rect(x + 3, 20, 2, 50)), stage_colour(0)), 2 * 40);
  EXPECT_EQ(image.at<cv::Vec3b>(20 + 1, x), cv::Vec3b(60, 160, 240)) << "what is beyond the scale has a cap";
}

TEST(LatencyChart, NothingLeavesItsArea) {
  LatencyHistory history(300, {{{"a", 40000}, {"b", -5}}, 1e6});
  history.push_back({});
  cv::Mat image = blank();
  draw_latency_chart(image, kArea, history);
  cv::Mat outside = image.clone();
  outside(kArea).setTo(cv::Scalar::all(7));
  EXPECT_EQ(count(outside, cv::Scalar::all(7)), 80 * 120);
  draw_latency_chart(image, cv::Rect(200, 200, 10, 10), history);
  draw_latency_chart(image, kArea, {});
}

TEST(LatencyChart, EveryStageIsListedCloserTogetherWhereTheyAreMany) {
  constexpr std::size_t kStages = 9;
  cv::Mat image(60, 320, CV_8UC3, cv::Scalar::all(0));
  draw_stage_list(image, cv::Rect(0, 0, 304, 60), std::vector<StageTime>(kStages, {"a", 1000}), 3);
  for (std::size_t i = 0; i < kStages; ++i) EXPECT_GT(count(image, stage_colour(i)), 50) << i;
}

}  // namespace
}  // namespace houghstream::view
