#include "tools/view/drawing/labels.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace houghstream::view {
namespace {

const cv::Size kImage(320, 240);
const cv::Size kLabel(90, 16);

std::vector<Label> labels_at(const std::vector<cv::Rect>& things) {
  std::vector<Label> labels;
  for (const cv::Rect& thing : things) labels.push_back({"name 0.50", thing, {255, 255, 255}, 1});
  return labels;
}

std::vector<cv::Rect> placed(const std::vector<cv::Rect>& things, const std::vector<cv::Rect>& occupied = {}) {
  return place_labels(labels_at(things), std::vector<cv::Size>(things.size(), kLabel), kImage, occupied);
}

TEST(Labels, ALabelStandsAboveItsThingOrBelowWhereThereIsNoSpace) {
  EXPECT_EQ(placed({{100, 80, 50, 40}})[0], cv::Rect(cv::Point(100, 64), kLabel));
  EXPECT_EQ(placed({{100, 80, 50, 40}}, {{0, 60, 320, 20}})[0], cv::Rect(cv::Point(100, 120), kLabel));
}

TEST(Labels, NoneLeavesTheImage) {
  constexpr int kFar = std::numeric_limits<int>::max() - 10;
  const std::vector<cv::Rect> things = {
      {300, 2, 40, 30}, {-50, 230, 60, 60}, {kFar, -kFar, kFar, 5}, {-kFar, kFar, 3, kFar}};
  for (const cv::Rect& thing : things) {
    const cv::Rect place = placed({thing})[0];
    EXPECT_EQ(place & cv::Rect({}, kImage), place) << thing;
    EXPECT_EQ(place.size(), kLabel);
  }
  const cv::Rect wide = place_labels(labels_at({{10, 50, 5, 5}}), {{900, 16}}, kImage)[0];
  EXPECT_EQ(wide, cv::Rect(0, 34, 320, 16));
}

TEST(Labels, NoneCoversAnotherOrWhatIsOccupied) {
  const cv::Rect legend(0, 222, 150, 18);
  std::vector<cv::Rect> things(9, cv::Rect(100, 80, 50, 40));
  things.insert(things.end(), 3, cv::Rect(60, 200, 30, 38));
  std::vector<cv::Rect> places = placed(things, {legend});
  places.push_back(legend);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_FALSE(places[i].empty()) << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_TRUE((places[i] & places[j]).empty()) << i << " and " << j;
  }
}

TEST(Labels, WhereTheImageIsFullALabelIsLeftOut) {
  const std::vector<cv::Rect> places = placed(std::vector<cv::Rect>(60, cv::Rect(100, 80, 50, 40)));
  EXPECT_FALSE(places.front().empty());
  EXPECT_TRUE(places.back().empty());
  cv::Mat image(240, 320, CV_8UC3, cv::Scalar::all(0));
  draw_labels(image, labels_at(std::vector<cv::Rect>(60, cv::Rect(100, 80, 50, 40))));
  EXPECT_GT(cv::norm(image), 0.0);
}

}  // namespace
}  // namespace houghstream::view
