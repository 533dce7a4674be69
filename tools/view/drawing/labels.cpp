#include "tools/view/drawing/labels.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace houghstream::view {
namespace {

constexpr double kLabelScale = 0.45;  // of OpenCV's simplex font
constexpr int kPadding = 3;           // pixels beside the text
const cv::Scalar kDarkText(20, 20, 20);

cv::Scalar text_colour_on(const cv::Scalar& background) {
  const double brightness = 0.114 * background[0] + 0.587 * background[1] + 0.299 * background[2];
  return brightness > 130.0 ? kDarkText : cv::Scalar(255, 255, 255);
}

cv::Size size_of_label(const std::string& text) {
  int baseline = 0;
  const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kLabelScale, 1, &baseline);
  return {size.width + 2 * kPadding, size.height + baseline + 4};
}

bool is_free(const cv::Rect& place, const std::vector<cv::Rect>& occupied) {
  return std::none_of(occupied.begin(), occupied.end(),
                      [&](const cv::Rect& other) { return !(place & other).empty(); });
}

// Returns the free row nearest to that of `place`, at its column; nothing where the column is full.
cv::Rect nearest_free(const cv::Rect& place, int image_rows, const std::vector<cv::Rect>& occupied) {
  cv::Rect best;
  int best_distance = std::numeric_limits<int>::max();
  const auto consider = [&](int y) {
    const cv::Rect candidate(place.x, y, place.width, place.height);
    const int distance = std::abs(y - place.y);
    if (y < 0 || y + place.height > image_rows || distance >= best_distance || !is_free(candidate, occupied)) return;
    best = candidate;
    best_distance = distance;
  };
  // A free row nearest to another one is that row, or touches something occupied.
  consider(place.y);
  for (const cv::Rect& other : occupied) {
    consider(other.y - place.height);
    consider(other.br().y);
  }
  return best;
}

// Returns the part of `thing` in the image, or its nearest edge: a box off the wire may lie anywhere.
cv::Rect within(const cv::Rect& thing, const cv::Size& image) {
  const auto edge = [](std::int64_t at, int size) { return static_cast<int>(std::clamp<std::int64_t>(at, 0, size)); };
  const cv::Point first(edge(thing.x, image.width), edge(thing.y, image.height));
  const cv::Point last(edge(std::int64_t{thing.x} + thing.width, image.width),
                       edge(std::int64_t{thing.y} + thing.height, image.height));
  return {first, last};
}

cv::Rect place_label(const cv::Rect& anywhere, const cv::Size& size, const cv::Size& image,
                     const std::vector<cv::Rect>& occupied) {
  const cv::Rect thing = within(anywhere, image);
  const int width = std::min(size.width, image.width);
  const int height = std::min(size.height, image.height);
  const auto at = [&](int x, int y) {
    return cv::Rect(std::clamp(x, 0, image.width - width), std::clamp(y, 0, image.height - height), width, height);
  };
  const cv::Rect above = at(thing.x, thing.y - height);
  for (const cv::Rect& place : {above, at(thing.x, thing.br().y), at(thing.x, thing.y)}) {
    if (is_free(place, occupied)) return place;
  }
  return nearest_free(above, image.height, occupied);
}

}  // namespace

std::vector<cv::Rect> place_labels(const std::vector<Label>& labels, const std::vector<cv::Size>& sizes,
                                   const cv::Size& image, std::vector<cv::Rect> occupied) {
  std::vector<cv::Rect> places;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    places.push_back(place_label(labels[i].thing, sizes[i], image, occupied));
    if (!places.back().empty()) occupied.push_back(places.back());
  }
  return places;
}

void draw_labels(cv::Mat& image, const std::vector<Label>& labels, const std::vector<cv::Rect>& occupied) {
  std::vector<cv::Size> sizes;
  sizes.reserve(labels.size());
  for (const Label& label : labels) sizes.push_back(size_of_label(label.text));
  const std::vector<cv::Rect> places = place_labels(labels, sizes, image.size(), occupied);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (places[i].empty()) continue;
    cv::Mat ground = image(places[i]);
    ground.setTo(labels[i].background);
    int baseline = 0;
    const cv::Size text = cv::getTextSize(labels[i].text, cv::FONT_HERSHEY_SIMPLEX, kLabelScale, 1, &baseline);
    cv::putText(ground, labels[i].text, {kPadding, text.height + 2}, cv::FONT_HERSHEY_SIMPLEX, kLabelScale,
                text_colour_on(labels[i].background), 1, cv::LINE_AA);
  }
}

}  // namespace houghstream::view
