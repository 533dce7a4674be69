#include "tools/view/drawing/latency_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/view/drawing/overlay.hpp"

namespace houghstream::view {
namespace {

constexpr int kColumn = 3;  // pixels of one frame
constexpr double kChartText = 0.4;
const cv::Scalar kChartGround(52, 48, 46);
const cv::Scalar kMark(255, 255, 255);
const cv::Scalar kBeyond(60, 160, 240);

double milliseconds(const StageTime& stage) {
  return static_cast<double>(std::max<std::int64_t>(stage.duration_us, 0)) * 1e-3;
}

double height_ms(const FrameLatency& frame) {
  double sum = 0.0;
  for (const StageTime& stage : frame.stages) sum += milliseconds(stage);
  return std::max(sum, frame.total_ms.value_or(0.0));
}

// Returns the smallest of 1, 2, 5, 10, 20, 50... that is not below the value.
double round_up(double value) {
  double scale = std::pow(10.0, std::floor(std::log10(std::max(value, 1.0))));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (value <= factor * scale) return factor * scale;
  }
  return 10.0 * scale;
}

// Returns the top of the scale: it holds 95 of 100 frames, so that a single slow one does not flatten all others.
double scale_top(const LatencyHistory& history) {
  constexpr double kFraction = 0.95;
  std::vector<double> heights;
  heights.reserve(history.size());
  for (const FrameLatency& frame : history) heights.push_back(height_ms(frame));
  if (heights.empty()) return 0.0;
  std::sort(heights.begin(), heights.end());
  const double height = heights[static_cast<std::size_t>(kFraction * static_cast<double>(heights.size() - 1))];
  return height > 0.0 ? round_up(height) : 0.0;
}

void draw_frame(cv::Mat& image, const cv::Rect& column, const FrameLatency& frame, double top_ms) {
  constexpr int kCap = 3;  // pixels
  const auto row_of = [&](double ms) {
    return column.br().y - static_cast<int>(std::lround(std::min(ms / top_ms, 1.0) * column.height));
  };
  double from_ms = 0.0;
  for (std::size_t i = 0; i < frame.stages.size(); ++i) {
    const double to_ms = from_ms + milliseconds(frame.stages[i]);
    const cv::Rect part(column.x, row_of(to_ms), column.width, row_of(from_ms) - row_of(to_ms));
    if (!part.empty()) cv::rectangle(image, part, stage_colour(i), cv::FILLED);
    from_ms = to_ms;
  }
  if (frame.total_ms) {
    cv::rectangle(image, cv::Rect(column.x, std::min(row_of(*frame.total_ms), column.br().y - 1), column.width, 1),
                  kMark, cv::FILLED);
  }
  if (height_ms(frame) > top_ms)
    cv::rectangle(image, cv::Rect(column.x, column.y, column.width, kCap) & column, kBeyond, cv::FILLED);
}

}  // namespace

cv::Scalar stage_colour(std::size_t index) {
  constexpr int kHues = 180;         // OpenCV's full circle
  constexpr std::size_t kStep = 67;  // neighbours get hues far apart
  const auto hue = static_cast<std::uint8_t>((105 + index * kStep) % kHues);
  const cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(hue, 130, 205));
  cv::Mat bgr;
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  const auto pixel = bgr.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(pixel[0]), static_cast<double>(pixel[1]), static_cast<double>(pixel[2])};
}

void draw_stage_list(cv::Mat& image, const cv::Rect& area, const std::vector<StageTime>& stages, int rows) {
  constexpr int kWidth = 152;  // of most entries; the longest need a little more, for which the last column has space
  constexpr int kPitch = 159;
  constexpr int kSquare = 10;
  const int columns = std::max(1, (area.width + 1) / kWidth);
  const int needed = (static_cast<int>(stages.size()) + columns - 1) / columns;
  rows = std::max(rows, needed);  // closer together where there are more: none goes unsaid
  const int row_height = area.height / rows;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const cv::Point corner(area.x + static_cast<int>(i) / rows * kPitch,
                           area.y + static_cast<int>(i) % rows * row_height);
    const cv::Rect square(corner.x, corner.y + (row_height - kSquare) / 2, kSquare, kSquare);
    cv::rectangle(image, square, stage_colour(i), cv::FILLED);
    draw_text(image, fmt::format("{} {:.1f}", stages[i].stage, milliseconds(stages[i])),
              corner + cv::Point(kSquare + 4, row_height - 5), kChartText);
  }
}

void draw_latency_chart(cv::Mat& image, const cv::Rect& area, const LatencyHistory& history) {
  const cv::Rect inside = area & cv::Rect(0, 0, image.cols, image.rows);
  if (inside.empty()) return;
  cv::rectangle(image, inside, kChartGround, cv::FILLED);
  const double top_ms = scale_top(history);
  if (top_ms <= 0.0) return;
  int x = inside.br().x - kColumn;
  for (auto frame = history.rbegin(); frame != history.rend() && x >= inside.x; ++frame, x -= kColumn) {
    draw_frame(image, cv::Rect(x, inside.y, kColumn - 1, inside.height), *frame, top_ms);
  }
  double highest = 0.0;
  for (const FrameLatency& frame : history) highest = std::max(highest, height_ms(frame));
  const std::string beyond = highest > top_ms ? fmt::format(", orange: up to {:.0f} ms", highest) : "";
  draw_text(image, fmt::format("{:.0f} ms{}", top_ms, beyond), {inside.x + 3, inside.y + 12}, kChartText);
}

}  // namespace houghstream::view
