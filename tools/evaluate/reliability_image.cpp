#include "tools/evaluate/reliability_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

namespace houghstream {
namespace {

constexpr int kSide = 400;   // side of a diagram
constexpr int kCounts = 90;  // height of the bars below it
constexpr int kGap = 28;     // gap between them, for the numbers
constexpr int kMargin = 64;  // margin left of it, for the numbers, and above
constexpr int kWidth = kMargin + kSide + 32;
constexpr int kHeight = kMargin + kSide + kGap + kCounts + 60;

const cv::Scalar kInk(60, 60, 60);
const cv::Scalar kGrid(225, 225, 225);
const cv::Scalar kBar(196, 148, 86);
const cv::Scalar kCountBar(180, 180, 180);
const cv::Scalar kGapColour(80, 80, 220);

/// Draws in a panel, whose origin is the diagram's lower left corner; x and y from 0 to 1.
class Panel {
 public:
  Panel(cv::Mat image, const Calibration& calibration, const std::string& name)
      : image_(std::move(image)), calibration_(calibration), name_(name) {}

  void draw() {
    draw_grid();
    for (const ReliabilityBin& bin : calibration_.bins) draw_bin(bin);
    cv::line(image_, at(0, 0), at(1, 1), kInk, 1, cv::LINE_AA);
    cv::rectangle(image_, at(0, 1), at(1, 0), kInk, 1);
    draw_counts();
    const std::string error = std::isfinite(calibration_.ece) ? fmt::format("{:.3f}", calibration_.ece) : "-";
    text(fmt::format("{}: {} judged, ECE {}", name_, calibration_.count, error), {kMargin, 36}, 0.6);
    text(fmt::format("stated {}", name_), {kMargin + kSide / 2 - 60, kHeight - 12}, 0.5);
    text("true", {8, kMargin - 12}, 0.5);
  }

 private:
  static cv::Point at(double x, double y) {
    return {kMargin + static_cast<int>(std::lround(x * kSide)),
            kMargin + static_cast<int>(std::lround((1 - y) * kSide))};
  }

  void text(const std::string& words, const cv::Point& corner, double size) {
    cv::putText(image_, words, corner, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
  }

  void draw_grid() {
    for (int i = 0; i <= 10; i += 2) {
      const double fraction = i / 10.0;
      cv::line(image_, at(fraction, 0), at(fraction, 1), kGrid, 1);
      cv::line(image_, at(0, fraction), at(1, fraction), kGrid, 1);
      text(fmt::format("{:.1f}", fraction), at(fraction, 0) + cv::Point(-12, 20), 0.42);
      text(fmt::format("{:.1f}", fraction), at(0, fraction) + cv::Point(-34, 5), 0.42);
    }
  }

  /// Draws the true fraction, a dot at the mean prediction, and their difference.
  void draw_bin(const ReliabilityBin& bin) {
    if (bin.count == 0) return;
    const cv::Point gap(2, 0);
    cv::rectangle(image_, at(bin.from, bin.true_fraction) + gap, at(bin.to, 0) - gap, kBar, cv::FILLED);
    const cv::Point mean = at(bin.mean_score, bin.true_fraction);
    cv::line(image_, mean, at(bin.mean_score, bin.mean_score), kGapColour, 2, cv::LINE_AA);
    cv::circle(image_, mean, 4, kGapColour, cv::FILLED, cv::LINE_AA);
  }

  /// Draws bars as high as the logarithm of the bin's count, so that a few are visible beside many.
  void draw_counts() {
    int maximum = 1;
    for (const ReliabilityBin& bin : calibration_.bins) maximum = std::max(maximum, bin.count);
    const int bottom = kMargin + kSide + kGap + kCounts;
    constexpr int kTextHeight = 14;
    for (const ReliabilityBin& bin : calibration_.bins) {
      const double fraction = std::log1p(bin.count) / std::log1p(maximum);
      const int top = bottom - static_cast<int>(std::lround(fraction * (kCounts - kTextHeight)));
      cv::rectangle(image_, {at(bin.from, 0).x + 2, top}, {at(bin.to, 0).x - 2, bottom}, kCountBar, cv::FILLED);
      text(std::to_string(bin.count), {at(bin.from, 0).x + 3, top - 3}, 0.36);
    }
  }

  cv::Mat image_;
  const Calibration& calibration_;
  std::string name_;
};

}  // namespace

cv::Mat reliability_image(const Calibration& score, const Calibration& quality) {
  cv::Mat image(kHeight, 2 * kWidth, CV_8UC3, cv::Scalar::all(255));
  Panel(image.colRange(0, kWidth), score, "score").draw();
  Panel(image.colRange(kWidth, 2 * kWidth), quality, "quality").draw();
  return image;
}

}  // namespace houghstream
