#include "pipeline/types/brightness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "pipeline/base/check_settings.hpp"

namespace houghstream {
namespace {

struct GreyStatistics {
  double mean = 0.0;
  double deviation = 0.0;
};

GreyStatistics grey_statistics(const cv::Mat& colour) {
  constexpr int kStep = 4;
  std::uint64_t count = 0;
  std::uint64_t sum = 0;
  std::uint64_t squares = 0;
  for (int y = 0; y < colour.rows; y += kStep) {
    const auto* row = colour.ptr<cv::Vec3b>(y);
    for (int x = 0; x < colour.cols; x += kStep) {
      const std::uint64_t grey = 114U * row[x][0] + 587U * row[x][1] + 299U * row[x][2];
      ++count;
      sum += grey;
      squares += grey * grey;
    }
  }
  const double mean = static_cast<double>(sum) / static_cast<double>(count);
  const double variance = static_cast<double>(squares) / static_cast<double>(count) - mean * mean;
  return {mean * 1e-3, std::sqrt(std::max(0.0, variance)) * 1e-3};
}

}  // namespace

void check_settings(const BrightnessRange& range, const std::string& source) {
  check_fields(range, source);
  require(range.min_mean <= range.max_mean, "{}: least_mean {}, expected no more than the most_mean of {}", source,
          range.min_mean, range.max_mean);
}

AffineBrightness fit_affine_brightness(const cv::Mat& colour, const BrightnessRange& range) {
  constexpr double kMinGain = 0.6;
  if (range.min_mean <= 0.0F && range.max_mean >= 255.0F && range.max_deviation >= 127.5F) return {};
  const GreyStatistics grey = grey_statistics(colour);
  const double gain =
      grey.deviation > range.max_deviation ? std::max<double>(kMinGain, range.max_deviation / grey.deviation) : 1.0;
  const double mean = std::clamp<double>(grey.mean, range.min_mean, range.max_mean);
  return {static_cast<float>(gain), static_cast<float>(mean - gain * grey.mean)};
}

void apply_affine_brightness(const AffineBrightness& curve, const cv::Mat& colour, cv::Mat& out) {
  std::array<std::uint8_t, 256> table{};
  for (std::size_t v = 0; v < table.size(); ++v)
    table[v] = cv::saturate_cast<std::uint8_t>(curve.gain * static_cast<float>(v) + curve.offset);
  cv::LUT(colour, cv::Mat(1, 256, CV_8UC1, table.data()), out);
}

}  // namespace houghstream
