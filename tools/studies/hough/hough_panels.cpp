#include "tools/studies/hough/hough_panels.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "tools/view/drawing/overlay.hpp"
#include "tools/view/drawing/tiles.hpp"

namespace houghstream {
namespace {

constexpr int kCaptionHeight = 28;
constexpr int kBarWidth = 120;
constexpr std::size_t kShownBoxes = 5;  // a maximum, since more would hide the votes

double highest_value(const cv::Mat& votes) {
  double highest = 0.0;
  cv::minMaxLoc(votes, nullptr, &highest);
  return highest;
}

cv::Mat colours_of(const cv::Mat& votes, double top) {
  cv::Mat bytes;
  votes.convertTo(bytes, CV_8UC1, top > 0.0 ? 255.0 / top : 0.0);
  cv::Mat colours;
  cv::applyColorMap(bytes, colours, cv::COLORMAP_INFERNO);
  return colours;
}

cv::Mat darkened_grey(const cv::Mat& colour) {
  cv::Mat grey;
  cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
  cv::cvtColor(0.35 * grey, grey, cv::COLOR_GRAY2BGR);
  return grey;
}

/// Few votes let the frame show through, many do not.
cv::Mat votes_over(const cv::Mat& ground, const cv::Mat& votes, double top) {
  const cv::Mat colours = colours_of(votes, top);
  cv::Mat image(ground.size(), CV_8UC3);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const float fraction = top > 0.0 ? std::min(1.0F, 3.0F * votes.at<float>(y, x) / static_cast<float>(top)) : 0.0F;
      image.at<cv::Vec3b>(y, x) =
          colours.at<cv::Vec3b>(y, x) * fraction + ground.at<cv::Vec3b>(y, x) * (1.0F - fraction);
    }
  }
  return image;
}

void draw_box(cv::Mat& image, const NamedBox& box) {
  const cv::Rect edges = box.box_px;
  cv::rectangle(image, edges, cv::Scalar(20, 20, 20), 3);
  cv::rectangle(image, edges, box.colour, 1);
  constexpr int kTextHeight = 14;
  const int y = edges.y < kTextHeight ? std::min(edges.br().y + kTextHeight, image.rows - 4) : edges.y - 4;
  view::draw_text(image, box.words, {std::max(edges.x, 2), y}, 0.45, box.colour);
}

/// Returns the image below its title; with a colour bar for the values, unless `top` is nothing.
cv::Mat captioned(const cv::Mat& image, const std::string& title, double top) {
  cv::Mat tile(image.rows + kCaptionHeight, image.cols, CV_8UC3, cv::Scalar(0, 0, 0));
  image.copyTo(tile.rowRange(kCaptionHeight, tile.rows));
  const int baseline = kCaptionHeight - 9;
  view::draw_text(tile, title, {6, baseline}, 0.5);
  if (!(top > 0.0)) return tile;
  const std::string end = fmt::format("{:.2f}", top);
  const int right = tile.cols - 6 - cv::getTextSize(end, cv::FONT_HERSHEY_SIMPLEX, 0.45, 1, nullptr).width;
  const cv::Rect place(right - kBarWidth - 6, 7, kBarWidth, kCaptionHeight - 14);
  if (place.x < tile.cols / 2) return tile;
  cv::Mat ramp(1, kBarWidth, CV_32FC1);
  for (int x = 0; x < kBarWidth; ++x) ramp.at<float>(0, x) = static_cast<float>(x) / (kBarWidth - 1);
  cv::repeat(colours_of(ramp, 1.0), place.height, 1, tile(place));
  cv::rectangle(tile, place, cv::Scalar(120, 120, 120));
  view::draw_text(tile, "0", {place.x - 14, baseline});
  view::draw_text(tile, end, {right, baseline});
  return tile;
}

cv::Mat class_tile(const cv::Mat& ground, const HoughPanel& panel, double top) {
  cv::Mat image = votes_over(ground, panel.votes, top);
  const std::size_t shown = std::min(kShownBoxes, panel.found.size());
  for (std::size_t i = shown; i-- > 0;) draw_box(image, panel.found[i]);
  std::string title = fmt::format("{}: highest {:.2f}", panel.title, highest_value(panel.votes));
  if (shown < panel.found.size()) title += fmt::format("; {} of {} boxes", shown, panel.found.size());
  return captioned(image, title, top);
}

}  // namespace

cv::Mat draw_hough_panels(const cv::Mat& colour, const std::vector<NamedBox>& truth,
                          const std::vector<HoughPanel>& panels) {
  double top = 0.0;
  for (const HoughPanel& panel : panels) {
    require(panel.votes.size() == colour.size(), "votes for {}: {}x{}, expected the frame's {}x{}", panel.title,
            panel.votes.cols, panel.votes.rows, colour.cols, colour.rows);
    top = std::max(top, highest_value(panel.votes));
  }
  cv::Mat with_ground_truth = colour.clone();
  for (const NamedBox& box : truth) draw_box(with_ground_truth, box);
  std::vector<cv::Mat> tiles = {captioned(with_ground_truth, "true boxes", 0.0)};
  const cv::Mat ground = darkened_grey(colour);
  for (const HoughPanel& panel : panels) tiles.push_back(class_tile(ground, panel, top));
  return view::tiled(tiles, static_cast<int>(std::ceil(std::sqrt(tiles.size()))));
}

}  // namespace houghstream
