#include "detector/training/augmentation/dehazing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace houghstream::training {
namespace {

/// Returns the value below which `rank` of the counted pixels lie.
double quantile(const std::array<int, 256>& counts, int rank) {
  int sum = 0;
  for (std::size_t v = 0; v < counts.size(); ++v) {
    sum += counts[v];
    if (sum > rank) return static_cast<double>(v);
  }
  return 255.0;
}

}  // namespace

void remove_haze(const cv::Mat& mask, cv::Mat& colour, Random& random) {
  constexpr double kMaxHaze = 60.0;  // grey levels; more is the object's own brightness
  constexpr int kBrightest = 245;
  std::array<int, 256> darkest{};
  std::array<int, 256> brightest{};
  int count = 0;
  for (int y = 0; y < colour.rows; ++y) {
    for (int x = 0; x < colour.cols; ++x) {
      if (mask.at<std::uint8_t>(y, x) == 0) continue;
      const cv::Vec3b& pixel = colour.at<cv::Vec3b>(y, x);
      ++darkest[std::min({pixel[0], pixel[1], pixel[2]})];
      ++brightest[std::max({pixel[0], pixel[1], pixel[2]})];
      ++count;
    }
  }
  const double haze = random.uniform() * std::min(kMaxHaze, quantile(darkest, count / 20));
  const double top = std::max(haze + 1.0, quantile(brightest, count - count / 20));
  const double gain = std::exp2(random.uniform() * std::log2(std::max(1.0, (kBrightest - 0.0) / (top - haze))));
  const double saturation = std::exp2(random.uniform(-0.2, 0.5));
  for (int y = 0; y < colour.rows; ++y) {
    for (int x = 0; x < colour.cols; ++x) {
      cv::Vec3b& pixel = colour.at<cv::Vec3b>(y, x);
      const double grey = (pixel[0] + pixel[1] + pixel[2]) / 3.0;
      for (int c = 0; c < 3; ++c) {
        pixel[c] = cv::saturate_cast<std::uint8_t>(gain * (grey + saturation * (pixel[c] - grey) - haze));
      }
    }
  }
}

cv::Mat apply_unsharp_mask(const cv::Mat& colour, double sharpness) {
  constexpr double kSigma = 1.5;  // pixels
  if (sharpness <= 0.0) return colour;
  cv::Mat soft;
  cv::Mat sharp;
  cv::GaussianBlur(colour, soft, cv::Size(), kSigma);
  cv::addWeighted(colour, 1.0 + sharpness, soft, -sharpness, 0.0, sharp);
  return sharp;
}

}  // namespace houghstream::training
