#include "tools/view/drawing/labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

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

struct Crowd {
  std::vector<cv::Rect> things;
  std::vector<cv::Size> sizes;
};

// Returns objects that stand close to one another, with names as wide as those of tracks.
Crowd close_objects(unsigned seed, int count) {
  std::mt19937 random(seed);
  const auto between = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  Crowd crowd;
  for (int i = 0; i < count; ++i) {
    const cv::Size size(between(20, 80), between(20, 90));
    crowd.things.emplace_back(cv::Point(between(140, 430), between(120, 330)), size);
    crowd.sizes.emplace_back(between(90, 240), 16);
  }
  return crowd;
}

bool covers_any(const cv::Rect& place, const std::vector<cv::Rect>& others) {
  return std::any_of(others.begin(), others.end(), [&](const cv::Rect& other) { return !(place & other).empty(); });
}

// Returns whether a label of this size has, along one side of its thing, a place in the image that covers none of
// these.
bool has_place_along(const cv::Rect& thing, const cv::Size& size, const cv::Rect& image,
                     const std::vector<cv::Rect>& others) {
  const auto fits = [&](int x, int y) {
    const cv::Rect place(cv::Point(x, y), size);
    return (place & image) == place && !covers_any(place, others);
  };
  const auto [left, right] = std::minmax({thing.x, thing.br().x - size.width});
  for (int x = left; x <= right; ++x) {
    if (fits(x, thing.y - size.height) || fits(x, thing.br().y)) return true;
  }
  const auto [top, bottom] = std::minmax({thing.y, thing.br().y - size.height});
  for (int y = top; y <= bottom; ++y) {
    if (fits(thing.x - size.width, y) || fits(thing.br().x, y)) return true;
  }
  return false;
}

TEST(Labels, OfCloseObjectsNoNameCoversANeighbourThatItCanLeaveFree) {
  const cv::Rect image(0, 0, 640, 480);
  const cv::Rect legend(0, 462, 150, 18);
  int covering = 0;
  int names = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Crowd crowd = close_objects(seed, 14);
    const std::vector<cv::Rect> places = place_labels(labels_at(crowd.things), crowd.sizes, image.size(), {legend});
    std::vector<cv::Rect> before = {legend};
    for (std::size_t i = 0; i < places.size(); ++i) {
      ASSERT_EQ(places[i] & image, places[i]) << seed << ": leaves the image";
      ASSERT_EQ(places[i].size(), crowd.sizes[i]) << seed << ": is left out";
      ASSERT_FALSE(covers_any(places[i], before)) << seed << ": covers another name or the legend";
      std::vector<cv::Rect> neighbours = crowd.things;
      neighbours.erase(neighbours.begin() + static_cast<std::ptrdiff_t>(i));
      const bool covers = covers_any(places[i], neighbours);
      neighbours.insert(neighbours.end(), before.begin(), before.end());
      EXPECT_FALSE(covers && has_place_along(crowd.things[i], crowd.sizes[i], image, neighbours))
          << seed << ", name " << i << ": covers a neighbour, beside a place that is free";
      covering += covers ? 1 : 0;
      ++names;
      before.push_back(places[i]);
    }
  }
  EXPECT_LT(covering, names / 20) << "of " << names;
}

TEST(Labels, ANameThatStandsApartHasALineToItsThing) {
  const cv::Rect thing(150, 110, 20, 20);
  const cv::Rect crowd(60, 60, 200, 120);
  cv::Mat image(kImage, CV_8UC3, cv::Scalar::all(0));
  std::vector<Label> labels = labels_at({thing, crowd});
  labels[0].background = {0, 0, 255};
  labels[1].background = {0, 255, 0};
  draw_labels(image, labels);
  cv::Mat red;
  cv::extractChannel(image(crowd), red, 2);
  EXPECT_GT(cv::countNonZero(red > 100), 20) << "a line runs to the thing through what stands around it";
  EXPECT_LT(cv::countNonZero(red > 100), 200) << "no name stands on its neighbour";
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
