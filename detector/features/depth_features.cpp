#include <opencv2/imgproc.hpp>

#include "detector/features/features.hpp"

namespace houghstream {

namespace {

/// Derivative per working pixel, smoothed by a Sobel kernel normalised to unit gain.
cv::Mat depth_derivative(const cv::Mat& depth, int dx, int dy, int kernel_px) {
  cv::Mat kernel_x;
  cv::Mat kernel_y;
  cv::getDerivKernels(kernel_x, kernel_y, dx, dy, kernel_px, true, CV_32F);
  cv::Mat out;
  cv::sepFilter2D(depth, out, CV_32F, kernel_x, kernel_y, cv::Point(-1, -1), 0.0, cv::BORDER_REPLICATE);
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
  constexpr float kMaxSlope = 2.5F;       // metres per metre: 68 degrees
  constexpr float kMaxCurvature = 60.0F;  // 1/metres: a cylinder of 17 mm radius
  DepthPlanes planes;
  const bool derivatives = (settings.families & kDepthDerivatives) != 0;
  const bool hog = (settings.families & kDepthHog) != 0;
  if (!derivatives && !hog) return planes;
  const auto slope = [&](int dx, int dy, int power, float limit) {
    cv::Mat out = depth_derivative(frame.filled_depth, dx, dy, settings.depth_sobel_px);
    make_metric(out, frame, power, limit);
    return out;
  };
  const auto add_bytes = [&](const cv::Mat& metric, float limit) {
    cv::Mat bytes;
    metric.convertTo(bytes, CV_8U, 127.0 / limit, 128.0);
    planes.derivatives.push_back(bytes);
  };
  const cv::Mat dx = slope(1, 0, 1, kMaxSlope);
  const cv::Mat dy = slope(0, 1, 1, kMaxSlope);
  if (derivatives) {
    add_bytes(dx, kMaxSlope);
    add_bytes(dy, kMaxSlope);
    add_bytes(slope(2, 0, 2, kMaxCurvature), kMaxCurvature);
    add_bytes(slope(0, 2, 2, kMaxCurvature), kMaxCurvature);
  }
  if (hog) planes.hog = gradient_histograms(dx, dy, 160.0F);
  return planes;
}

}  // namespace houghstream
