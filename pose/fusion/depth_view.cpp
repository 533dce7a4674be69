#include "pose/fusion/depth_view.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/no_value.hpp"

namespace houghstream::fusion {
namespace {

constexpr int kRadius_px = 3;  // radius of the neighbourhood whose plane gives the normal

/// Computes the plane's normal n with n.X = 1 for its points X: 1/z is linear in the pixel, so that the fit is linear.
/// Returns false where too few pixels around belong to the same surface.
bool fit_plane(const cv::Mat& depth, const Camera& camera, int x, int y, Eigen::Vector3d& n) {
  constexpr float kSameSurface_m = 0.01F;
  constexpr int kMin = (2 * kRadius_px + 1) * (2 * kRadius_px + 1) * 2 / 5;
  const float z = depth.at<float>(y, x);
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  int count = 0;
  for (int v = std::max(0, y - kRadius_px); v <= std::min(depth.rows - 1, y + kRadius_px); ++v) {
    for (int u = std::max(0, x - kRadius_px); u <= std::min(depth.cols - 1, x + kRadius_px); ++u) {
      const float near_z = depth.at<float>(v, u);
      if (!(std::abs(near_z - z) < kSameSurface_m)) continue;
      const Eigen::Vector3d ray = camera.backproject(u, v, 1.0);
      squares += ray * ray.transpose();
      sums += ray / static_cast<double>(near_z);
      ++count;
    }
  }
  if (count < kMin) return false;
  n = squares.ldlt().solve(sums);
  return n.allFinite() && n.norm() > 0.0;
}

void set_surface(const cv::Mat& depth, DepthView& out) {
  constexpr double kMinFacing = 0.2;
  out.depth = cv::Mat(depth.size(), CV_32FC1, cv::Scalar(kNoValue));
  out.normals = cv::Mat(depth.size(), CV_32FC3, cv::Scalar::all(0.0));
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      Eigen::Vector3d n;
      if (!std::isfinite(depth.at<float>(y, x)) || !fit_plane(depth, out.camera, x, y, n)) continue;
      n = -n.normalized();
      if (-n.dot(out.camera.backproject(x, y, 1.0).normalized()) < kMinFacing) continue;
      out.depth.at<float>(y, x) = depth.at<float>(y, x);
      out.normals.at<cv::Vec3f>(y, x) = cv::Vec3f(Eigen::Vector3f(n.cast<float>()).data());
    }
  }
}

/// Returns the mask without specks, which are not of the object.
cv::Mat without_specks(const cv::Mat& mask) {
  constexpr double kMinFraction = 0.02;  // fraction of the largest part
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
  double largest = 0.0;
  for (const auto& outline : outlines) largest = std::max(largest, cv::contourArea(outline));
  cv::Mat kept = cv::Mat::zeros(mask.size(), CV_8UC1);
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    if (cv::contourArea(outlines[i]) < kMinFraction * largest) continue;
    cv::drawContours(kept, outlines, static_cast<int>(i), cv::Scalar(255), cv::FILLED);
  }
  return kept & mask;
}

/// Masks and depth are a pixel or two wrong at the outline.
cv::Mat widened(const cv::Mat& mask) {
  constexpr int kMargin_px = 2;
  const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * kMargin_px + 1, 2 * kMargin_px + 1});
  cv::Mat wide;
  cv::dilate(mask, wide, kernel);
  return wide;
}

/// Returns the outside of the mask's convex hull: a mask made of depth has holes where depth is missing, at its outline
/// too, but the object lies within its hull.
cv::Mat outside_hull(const cv::Mat& mask) {
  std::vector<cv::Point> points;
  cv::findNonZero(mask, points);
  cv::Mat outside(mask.size(), CV_8UC1, cv::Scalar(255));
  if (points.empty()) return outside;
  std::vector<cv::Point> hull;
  cv::convexHull(points, hull);
  cv::fillConvexPoly(outside, hull, cv::Scalar(0));
  return outside;
}

cv::Mat outside_of(const cv::Mat& mask, const cv::Mat& depth) {
  constexpr double kMinFraction = 0.02;  // fraction of the pixels beside the mask
  const cv::Mat wide = widened(mask);
  const cv::Mat beside = wide == 0;
  const int with_depth = cv::countNonZero(beside & (depth == depth));
  return with_depth > kMinFraction * cv::countNonZero(beside) ? beside : outside_hull(wide);
}

/// Returns the pixel of `area` that shows a point of the camera frame.
std::optional<cv::Point> pixel_in(const cv::Rect& area, const Camera& camera, const Eigen::Vector3d& point_camera) {
  if (point_camera.z() <= 0.0) return std::nullopt;
  const Eigen::Vector2d at = camera.project(point_camera);
  const cv::Point px(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y())));
  if (!area.contains(px)) return std::nullopt;
  return px;
}

}  // namespace

std::optional<cv::Point> DepthView::pixel_of(const Eigen::Vector3d& point_camera) const {
  return pixel_in({{0, 0}, depth.size()}, camera, point_camera);
}

bool DepthView::is_in_image(const Eigen::Vector3d& point_camera) const {
  return !image || pixel_in(*image, camera, point_camera);
}

DepthView make_depth_view(const TrainingView& view) {
  DepthView out;
  out.camera = view.frame.camera;
  out.T_camera_object = view.T_camera_object;
  out.colour = view.frame.colour;
  const cv::Mat mask = without_specks(view.mask);
  cv::Mat depth = view.frame.depth.clone();
  depth.setTo(kNoValue, mask == 0);
  set_surface(depth, out);
  out.free_space_mask = outside_of(mask, view.frame.depth);
  return out;
}

std::vector<SurfaceSample> sample_view(const DepthView& view, int maximum) {
  const int pixels = cv::countNonZero(view.depth == view.depth);
  const int step = std::max(1, static_cast<int>(std::lround(std::sqrt(static_cast<double>(pixels) / maximum))));
  std::vector<SurfaceSample> samples;
  for (int y = 0; y < view.depth.rows; y += step) {
    for (int x = 0; x < view.depth.cols; x += step) {
      const float z = view.depth.at<float>(y, x);
      if (std::isfinite(z)) samples.push_back({view.camera.backproject(x, y, z), view.normal({x, y})});
    }
  }
  return samples;
}

}  // namespace houghstream::fusion
