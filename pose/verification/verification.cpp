#include "pose/verification/verification.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/geometry/renderer.hpp"

namespace houghstream {
namespace {

/// The part of the image that shows the mesh; the whole image where a vertex is at or behind the camera.
cv::Rect bounds_px(const Mesh& mesh, const Eigen::Isometry3d& T_camera_object, const Camera& camera) {
  Eigen::Vector2d low(camera.width, camera.height);
  Eigen::Vector2d high(-1.0, -1.0);
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d point = T_camera_object * vertex.cast<double>();
    if (!(point.z() > 0.0)) return {0, 0, camera.width, camera.height};
    const Eigen::Vector2d pixel = camera.project(point);
    low = low.cwiseMin(pixel);
    high = high.cwiseMax(pixel);
  }
  const auto clip = [](double v, int limit) { return v > 0.0 ? static_cast<int>(std::min<double>(v, limit)) : 0; };
  const int left = clip(low.x(), camera.width);
  const int top = clip(low.y(), camera.height);
  const int right = clip(std::floor(high.x()) + 1.0, camera.width);
  const int bottom = clip(std::floor(high.y()) + 1.0, camera.height);
  return {left, top, std::max(0, right - left), std::max(0, bottom - top)};
}

/// Looks `reach_px` outside the outline, to the left and right of each row's and above and below each column's.
void compare_outline(const RgbdFrame& frame, const cv::Mat& rendered, const cv::Rect& region,
                     const DepthTolerance& tolerance, Verification& result) {
  constexpr double kReach = 0.008;  // metres outside
  const auto is_model = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < rendered.cols && y < rendered.rows && !std::isnan(rendered.at<float>(y, x));
  };
  const std::array<cv::Point, 4> sides{cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}};
  for (int y = 0; y < rendered.rows; ++y) {
    for (int x = 0; x < rendered.cols; ++x) {
      if (!is_model(x, y)) continue;
      const float z = rendered.at<float>(y, x);
      for (const cv::Point& side : sides) {
        if (is_model(x + side.x, y + side.y)) continue;
        const int reach_px = 1 + static_cast<int>(kReach / frame.camera.metres_per_px(z));
        const cv::Point there = cv::Point(x, y) + reach_px * side;
        if (is_model(there.x, there.y)) continue;  // across a notch
        const cv::Point pixel = there + region.tl();
        if (!cv::Rect(cv::Point(), frame.depth.size()).contains(pixel)) continue;
        const float beyond = frame.depth.at<float>(pixel) - z;
        const auto limit = static_cast<float>(tolerance.at(z));
        result.outline_ends += beyond > limit ? 1 : 0;
        result.outline_continues += std::abs(beyond) <= limit ? 1 : 0;
      }
    }
  }
}

}  // namespace

float Verification::visible_fraction() const {
  return rendered == 0 ? 0.0F : static_cast<float>(agreeing) / static_cast<float>(rendered);
}

float Verification::free_space_violation() const {
  return rendered == 0 ? 0.0F : static_cast<float>(violating) / static_cast<float>(rendered);
}

Verification verify_look(const ViewLook& look, const DepthTolerance& tolerance) {
  constexpr float kEdge = 0.3F;  // cosine between normal and line of sight
  Verification result;
  for (std::size_t i = 0; i < look.looks.size(); ++i) {
    const Eigen::Vector3f point = look.T * look.view.points[i];
    const Eigen::Vector3f normal = look.T.linear() * look.view.normals[i];
    if (!(-normal.dot(point) > kEdge * point.norm())) continue;
    ++result.rendered;
    const auto limit = static_cast<float>(tolerance.at(point.z()));
    const float beyond = look.looks[i].beyond;  // NaN where nothing was measured: no comparison holds
    result.agreeing += std::abs(beyond) <= limit ? 1 : 0;
    result.violating += beyond > limit ? 1 : 0;
    result.occluded += beyond < -limit ? 1 : 0;
  }
  return result;
}

Verification verify_pose(const RgbdFrame& frame, const Mesh& mesh, const Eigen::Isometry3d& T_camera_object,
                         const DepthTolerance& tolerance) {
  Verification result;
  const cv::Rect region = bounds_px(mesh, T_camera_object, frame.camera);
  if (region.area() == 0) return result;
  const cv::Mat rendered = render_depth(mesh, T_camera_object, frame.camera, region);
  for (int y = 0; y < region.height; ++y) {
    const float* model = rendered.ptr<float>(y);
    const float* measured = frame.depth.ptr<float>(y + region.y) + region.x;
    for (int x = 0; x < region.width; ++x) {
      if (std::isnan(model[x])) continue;
      ++result.rendered;
      const auto limit = static_cast<float>(tolerance.at(model[x]));
      const float beyond = measured[x] - model[x];  // NaN where nothing was measured: no comparison holds
      result.agreeing += std::abs(beyond) <= limit ? 1 : 0;
      result.violating += beyond > limit ? 1 : 0;
      result.occluded += beyond < -limit ? 1 : 0;
    }
  }
  compare_outline(frame, rendered, region, tolerance, result);
  return result;
}

}  // namespace houghstream
