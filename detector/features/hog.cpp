#include <algorithm>
#include <cmath>

#include "detector/features/features.hpp"
#include "detector/features/tiles/tile_histograms.hpp"

namespace houghstream {

namespace {

constexpr int kBins = HistogramSteps::kBins;

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

/// Steps of each bin, see HistogramSteps.
std::vector<cv::Mat> shared_gradients(const cv::Mat& dx, const cv::Mat& dy, float gain) {
  std::vector<cv::Mat> planes(kBins);
  for (cv::Mat& plane : planes) plane = cv::Mat::zeros(dx.size(), CV_16UC1);
  const float steps = gain * HistogramSteps::kPerByte;
  for (int y = 0; y < dx.rows; ++y) {
    for (int x = 0; x < dx.cols; ++x) {
      const float gx = dx.at<float>(y, x);
      const float gy = dy.at<float>(y, x);
      const float magnitude = std::sqrt(gx * gx + gy * gy) * steps;
      const float bin = orientation_bin(gx, gy);
      const int low = static_cast<int>(bin);
      const float share = bin - static_cast<float>(low);
      const auto set = [&](int b, float part) {
        planes[static_cast<std::size_t>(b)].at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(part);
      };
      set(low, magnitude * (1.0F - share) + 0.5F);
      set(low + 1 == kBins ? 0 : low + 1, magnitude * share + 0.5F);
    }
  }
  return planes;
}

/// The window's sum along one axis; what lies outside is like the nearest pixel inside.
cv::Mat summed(const cv::Mat& plane, cv::Point axis) {
  cv::Mat out(plane.size(), CV_16UC1);
  for (int y = 0; y < plane.rows; ++y) {
    for (int x = 0; x < plane.cols; ++x) {
      const auto value = [&](int step) {
        return plane.at<std::uint16_t>(std::clamp(y + step * axis.y, 0, plane.rows - 1),
                                       std::clamp(x + step * axis.x, 0, plane.cols - 1));
      };
      std::uint32_t sum = (value(0) * std::uint32_t{HistogramSteps::kWeights[0]}) >> 16;
      for (const int step : {1, 2}) {
        const auto pair = static_cast<std::uint32_t>(value(-step) + value(step));
        sum += (pair * HistogramSteps::kWeights[static_cast<std::size_t>(step)]) >> 16;
      }
      out.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(sum);
    }
  }
  return out;
}

}  // namespace

std::vector<cv::Mat> gradient_histograms(const cv::Mat& dx, const cv::Mat& dy, float gain) {
  std::vector<cv::Mat> planes = shared_gradients(dx, dy, gain);
  for (cv::Mat& plane : planes) {
    const cv::Mat sums = summed(summed(plane, {0, 1}), {1, 0});
    plane = cv::Mat(sums.size(), CV_8UC1);
    constexpr int kPerByte = static_cast<int>(HistogramSteps::kPerByte);
    std::transform(sums.begin<std::uint16_t>(), sums.end<std::uint16_t>(), plane.begin<std::uint8_t>(), [](int steps) {
      return static_cast<std::uint8_t>(std::min((steps + kPerByte / 2 + HistogramSteps::kCut) / kPerByte, 255));
    });
  }
  return planes;
}

}  // namespace houghstream
