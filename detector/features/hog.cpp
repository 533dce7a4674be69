#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "detector/features/features.hpp"

namespace houghstream {

namespace {

constexpr int kBins = 9;

/// Orientation of a gradient in [0, 9) bins, unsigned; a polynomial arctangent (error below 0.3 degrees) so that the
/// result does not depend on the machine's mathematics library.
float orientation_bin(float dx, float dy) {
  const float ax = std::fabs(dx);
  const float ay = std::fabs(dy);
  const float big = ax > ay ? ax : ay;
  const float ratio = big > 0.0F ? (ax > ay ? ay : ax) / big : 0.0F;
  const float sq = ratio * ratio;
  float angle = ((-0.0464964749F * sq + 0.15931422F) * sq - 0.327622764F) * sq * ratio + ratio;
  if (ay > ax) angle = 1.57079637F - angle;
  if ((dx < 0.0F) != (dy < 0.0F)) angle = 3.14159274F - angle;
  const float bin = angle * (static_cast<float>(kBins) / 3.14159274F);
  return bin >= static_cast<float>(kBins) ? 0.0F : bin;
}

}  // namespace

std::vector<cv::Mat> gradient_histograms(const cv::Mat& dx, const cv::Mat& dy, float gain) {
  std::vector<cv::Mat> planes(kBins);
  for (cv::Mat& plane : planes) plane = cv::Mat::zeros(dx.size(), CV_32FC1);
  for (int y = 0; y < dx.rows; ++y) {
    const auto* gx = dx.ptr<float>(y);
    const auto* gy = dy.ptr<float>(y);
    std::array<float*, kBins> rows{};
    for (int b = 0; b < kBins; ++b)
      rows[static_cast<std::size_t>(b)] = planes[static_cast<std::size_t>(b)].ptr<float>(y);
    for (int x = 0; x < dx.cols; ++x) {
      const float magnitude = std::sqrt(gx[x] * gx[x] + gy[x] * gy[x]);
      const float bin = orientation_bin(gx[x], gy[x]);
      const int low = static_cast<int>(bin);
      const float share = bin - static_cast<float>(low);
      rows[static_cast<std::size_t>(low)][x] = magnitude * (1.0F - share);
      rows[static_cast<std::size_t>(low + 1 == kBins ? 0 : low + 1)][x] += magnitude * share;
    }
  }
  for (cv::Mat& plane : planes) {
    cv::Mat summed;
    cv::GaussianBlur(plane, summed, cv::Size(5, 5), 1.2, 1.2, cv::BORDER_REPLICATE);
    summed.convertTo(plane, CV_8U, gain);
  }
  return planes;
}

}  // namespace houghstream
