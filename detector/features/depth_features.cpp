#include <algorithm>

#include "detector/features/features.hpp"
#include "detector/features/tiles/tile_derivatives.hpp"

namespace houghstream {

namespace {

/// Sums of products with the kernel along one axis, from the first one to the last, in this order.
cv::Mat filtered(const cv::Mat& image, const std::vector<float>& kernel, cv::Point axis) {
  cv::Mat out(image.size(), CV_32FC1);
  const int half = static_cast<int>(kernel.size()) / 2;
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      const auto product = [&](int i) {
        const int row = std::clamp(y + (i - half) * axis.y, 0, image.rows - 1);
        const int column = std::clamp(x + (i - half) * axis.x, 0, image.cols - 1);
        return image.at<float>(row, column) * kernel[static_cast<std::size_t>(i)];
      };
      float sum = product(0);
      for (int i = 1; i <= 2 * half; ++i) sum += product(i);
      out.at<float>(y, x) = sum;
    }
  }
  return out;
}

/// Multiplies by (focal / depth)^power: from per pixel to per metre on the object. NaN becomes 0 and values are
/// limited, since an occluding edge is no slope of a surface.
void make_metric(cv::Mat& derivative, const WorkingFrame& frame, int power, float limit) {
  const auto focal = static_cast<float>(frame.camera.fx);
  for (int y = 0; y < derivative.rows; ++y) {
    auto* out = derivative.ptr<float>(y);
    const auto* depth = frame.filled_depth.ptr<float>(y);
    for (int x = 0; x < derivative.cols; ++x) {
      const float per_metre = focal / depth[x];
      const float value = out[x] * (power == 1 ? per_metre : per_metre * per_metre);
      const float limited = value > limit ? limit : (value < -limit ? -limit : value);
      out[x] = value == value ? limited : 0.0F;
    }
  }
}

}  // namespace

DepthPlanes depth_planes(const WorkingFrame& frame, const FeatureSettings& settings) {
  DepthPlanes planes;
  const bool derivatives = (settings.families & kDepthDerivatives) != 0;
  const bool hog = (settings.families & kDepthHog) != 0;
  if (!derivatives && !hog) return planes;
  const SobelKernels kernels = sobel_kernels(settings.depth_sobel_px);
  const auto slope = [&](std::size_t order_x, std::size_t order_y, int power, float limit) {
    cv::Mat out = filtered(filtered(frame.filled_depth, kernels[order_y], {0, 1}), kernels[order_x], {1, 0});
    make_metric(out, frame, power, limit);
    return out;
  };
  const auto add_bytes = [&](const cv::Mat& metric, float limit) {
    cv::Mat bytes(metric.size(), CV_8UC1);
    std::transform(metric.begin<float>(), metric.end<float>(), bytes.begin<std::uint8_t>(),
                   [&](float value) { return static_cast<std::uint8_t>(value * (127.0F / limit) + 128.5F); });
    planes.derivatives.push_back(bytes);
  };
  const cv::Mat dx = slope(1, 0, 1, SlopeLimits::kSlope);
  const cv::Mat dy = slope(0, 1, 1, SlopeLimits::kSlope);
  if (derivatives) {
    add_bytes(dx, SlopeLimits::kSlope);
    add_bytes(dy, SlopeLimits::kSlope);
    add_bytes(slope(2, 0, 2, SlopeLimits::kCurvature), SlopeLimits::kCurvature);
    add_bytes(slope(0, 2, 2, SlopeLimits::kCurvature), SlopeLimits::kCurvature);
  }
  if (hog) planes.hog = gradient_histograms(dx, dy, kDepthGain);
  return planes;
}

}  // namespace houghstream
