#include "tools/view/drawing/labels.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

namespace houghstream::view {
namespace {

constexpr double kLabelScale = 0.45;  // of OpenCV's simplex font
constexpr int kPadding = 3;           // pixels beside the text
constexpr int kReach = 16;            // half heights of a label that stands apart from its thing, at most
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

bool is_inside(const cv::Rect& place, const cv::Size& image) {
  return (place & cv::Rect({}, image)) == place;
}

// A line of places: the nearest to `wanted` is best, and one coordinate may be anything from `first` to `last`.
struct Places {
  cv::Rect wanted;
  bool is_row = true;  // x varies, otherwise y
  int first = 0;
  int last = 0;
};

// Returns the free place that is nearest to the wanted one; nothing where none is free.
std::optional<cv::Rect> nearest_free(const Places& places, const std::vector<cv::Rect>& occupied) {
  const cv::Rect& wanted = places.wanted;
  std::optional<cv::Rect> best;
  int best_distance = std::numeric_limits<int>::max();
  const auto consider = [&](int at) {
    const cv::Rect candidate = places.is_row ? cv::Rect(at, wanted.y, wanted.width, wanted.height)
                                             : cv::Rect(wanted.x, at, wanted.width, wanted.height);
    const int distance = std::abs(at - (places.is_row ? wanted.x : wanted.y));
    if (at < places.first || at > places.last || distance >= best_distance || !is_free(candidate, occupied)) return;
    best = candidate;
    best_distance = distance;
  };
  // The free place nearest to another one is that one, lies at an end of the line, or touches something occupied.
  consider(places.is_row ? wanted.x : wanted.y);
  consider(places.first);
  consider(places.last);
  for (const cv::Rect& other : occupied) {
    consider(places.is_row ? other.x - wanted.width : other.y - wanted.height);
    consider(places.is_row ? other.br().x : other.br().y);
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

// Returns the places of a label along the sides of its thing, within the image: one of the two spans lies in the other.
std::vector<Places> places_along(const cv::Rect& thing, const cv::Size& size, const cv::Size& image) {
  std::vector<Places> found;
  const auto add = [&](int x, int y, bool is_row) {
    const int along = is_row ? thing.x : thing.y;
    const int end = is_row ? thing.br().x - size.width : thing.br().y - size.height;
    const int room = is_row ? image.width - size.width : image.height - size.height;
    const int across = is_row ? y : x;
    const int across_room = is_row ? image.height - size.height : image.width - size.width;
    const int first = std::max(std::min(along, end), 0);
    const int last = std::min(std::max(along, end), room);
    if (first > last || across < 0 || across > across_room) return;
    const int wanted = std::clamp(along, first, last);
    found.push_back({{is_row ? wanted : x, is_row ? y : wanted, size.width, size.height}, is_row, first, last});
  };
  add(thing.x, thing.y - size.height, true);
  add(thing.x, thing.br().y, true);
  add(thing.br().x, thing.y, false);
  add(thing.x - size.width, thing.y, false);
  return found;
}

// Returns the free place along a side of the thing: above it before below, right and left, unless another side has one
// that lies less far along.
std::optional<cv::Rect> place_along(const std::vector<Places>& sides, const cv::Rect& thing,
                                    const std::vector<cv::Rect>& occupied) {
  std::optional<cv::Rect> best;
  int best_cost = std::numeric_limits<int>::max();
  int side_cost = 0;
  for (const Places& side : sides) {
    const std::optional<cv::Rect> place = nearest_free(side, occupied);
    const int cost = place ? side_cost + std::abs(place->x - thing.x) + std::abs(place->y - side.wanted.y) : best_cost;
    if (cost < best_cost) {
      best = place;
      best_cost = cost;
    }
    side_cost += side.wanted.height / 2;
  }
  return best;
}

// Returns the free place nearest to a wanted one, of those within reach of it on a grid.
std::optional<cv::Rect> place_near(const cv::Rect& wanted, const cv::Size& image,
                                   const std::vector<cv::Rect>& occupied) {
  const int step = std::max(wanted.height / 2, 1);
  std::optional<cv::Rect> best;
  int best_distance = std::numeric_limits<int>::max();
  for (int row = -kReach; row <= kReach; ++row) {
    for (int column = -kReach; column <= kReach; ++column) {
      const cv::Rect place = wanted + cv::Point(step * column, step * row);
      const int distance = row * row + column * column;
      if (distance >= best_distance || !is_inside(place, image) || !is_free(place, occupied)) continue;
      best = place;
      best_distance = distance;
    }
  }
  return best;
}

cv::Rect place_label(const cv::Rect& thing, const cv::Size& wanted_size, const cv::Size& image,
                     const std::vector<cv::Rect>& occupied, const std::vector<cv::Rect>& neighbours) {
  const cv::Size size(std::min(wanted_size.width, image.width), std::min(wanted_size.height, image.height));
  const auto at = [&](int x, int y) {
    const cv::Point corner(std::clamp(x, 0, image.width - size.width), std::clamp(y, 0, image.height - size.height));
    return cv::Rect(corner, size);
  };
  std::vector<cv::Rect> avoided = occupied;
  avoided.insert(avoided.end(), neighbours.begin(), neighbours.end());
  const std::vector<Places> sides = places_along(thing, size, image);
  const cv::Rect above = at(thing.x, thing.y - size.height);
  const cv::Rect within_thing = at(thing.x, thing.y);
  const bool is_roomy = size.width <= thing.width && 2 * size.height <= thing.height;
  if (const auto place = place_along(sides, thing, avoided)) return *place;
  if (is_roomy && is_free(within_thing, avoided)) return within_thing;
  if (const auto place = place_near(above, image, avoided)) return *place;
  if (const auto place = place_along(sides, thing, occupied)) return *place;
  if (is_free(within_thing, occupied)) return within_thing;
  return nearest_free({above, false, 0, image.height - size.height}, occupied).value_or(cv::Rect());
}

// Draws a line from a label that stands apart to the middle of its thing.
void draw_line_to_thing(cv::Mat& image, const cv::Rect& place, const cv::Rect& thing, const cv::Scalar& colour) {
  const cv::Rect around(place.x - 1, place.y - 1, place.width + 2, place.height + 2);
  if (!(around & thing).empty()) return;
  const cv::Point middle = (thing.tl() + thing.br()) / 2;
  const cv::Point end(std::clamp(middle.x, place.x, place.br().x - 1), std::clamp(middle.y, place.y, place.br().y - 1));
  cv::line(image, end, middle, kDarkText, 3, cv::LINE_AA);
  cv::line(image, end, middle, colour, 1, cv::LINE_AA);
}

}  // namespace

std::vector<cv::Rect> place_labels(const std::vector<Label>& labels, const std::vector<cv::Size>& sizes,
                                   const cv::Size& image, std::vector<cv::Rect> occupied) {
  std::vector<cv::Rect> things;
  things.reserve(labels.size());
  for (const Label& label : labels) things.push_back(within(label.thing, image));
  std::vector<cv::Rect> places;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::vector<cv::Rect> neighbours = things;
    neighbours.erase(neighbours.begin() + static_cast<std::ptrdiff_t>(i));
    places.push_back(place_label(things[i], sizes[i], image, occupied, neighbours));
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
    draw_line_to_thing(image, places[i], within(labels[i].thing, image.size()), labels[i].background);
  }
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
