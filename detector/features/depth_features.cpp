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

std::vector<cv::Mat> depth_planes(const WorkingFrame& frame, const FeatureSettings& settings) {
  constexpr float kMaxSlope = 2.5F;       // metres per metre: 68 degrees
  constexpr float kMaxCurvature = 60.0F;  // 1/metres: a cylinder of 17 mm radius
  cv::Mat dx = depth_derivative(frame.filled_depth, 1, 0, settings.depth_sobel_px);
  cv::Mat dy = depth_derivative(frame.filled_depth, 0, 1, settings.depth_sobel_px);
  cv::Mat dxx = depth_derivative(frame.filled_depth, 2, 0, settings.depth_sobel_px);
  cv::Mat dyy = depth_derivative(frame.filled_depth, 0, 2, settings.depth_sobel_px);
  make_metric(dx, frame, 1, kMaxSlope);
  make_metric(dy, frame, 1, kMaxSlope);
  make_metric(dxx, frame, 2, kMaxCurvature);
  make_metric(dyy, frame, 2, kMaxCurvature);

  std::vector<cv::Mat> planes(5);
  planes[0] = frame.filled_depth;
  dx.convertTo(planes[1], CV_8U, 127.0 / kMaxSlope, 128.0);
  dy.convertTo(planes[2], CV_8U, 127.0 / kMaxSlope, 128.0);
  dxx.convertTo(planes[3], CV_8U, 127.0 / kMaxCurvature, 128.0);
  dyy.convertTo(planes[4], CV_8U, 127.0 / kMaxCurvature, 128.0);
  for (cv::Mat& plane : gradient_histograms(dx, dy, 160.0F)) planes.push_back(std::move(plane));
  return planes;
}

}  // namespace houghstream
