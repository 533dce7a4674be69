#include "pose/verification.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/renderer.hpp"

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

/// Depth as far beyond `z` as that is beyond `z_inside`, on the plane through both: 1/z is linear in the pixel.
float gone_on(float z_inside, float z) {
  const float inverse = 2.0F / z - 1.0F / z_inside;
  return inverse > 0.0F ? 1.0F / inverse : std::numeric_limits<float>::infinity();
}

bool is_model(const cv::Mat& rendered, const cv::Point& at) {
  return cv::Rect(cv::Point(), rendered.size()).contains(at) && !std::isnan(rendered.at<float>(at));
}

/// Looks `outwards` from a pixel of the model's outline.
void compare_beyond(const RgbdFrame& frame, const cv::Mat& rendered, const cv::Point& corner, const cv::Point& at,
                    const cv::Point& outwards, float limit, Verification& result) {
  if (is_model(rendered, at + outwards)) return;  // across a notch
  const cv::Point pixel = at + outwards + corner;
  if (!cv::Rect(cv::Point(), frame.depth.size()).contains(pixel)) return;
  const float z = rendered.at<float>(at);
  const float z_on = is_model(rendered, at - outwards) ? gone_on(rendered.at<float>(at - outwards), z) : z;
  const float measured = frame.depth.at<float>(pixel);  // NaN fails both comparisons
  const bool is_behind = measured > std::max(z, z_on) + limit;
  result.outline_ends += is_behind ? 1 : 0;
  result.outline_continues += !is_behind && measured >= std::min(z, z_on) - limit ? 1 : 0;
}

/// Looks outside the outline, to the left and right of each row's and above and below each column's. Structured light
/// finds depth by correlating windows of about 9 pixels, so what it measures of an object is up to half a window wider
/// than the object: only beyond that does a surface go on.
void compare_outline(const RgbdFrame& frame, const cv::Mat& rendered, const cv::Rect& region,
                     const DepthTolerance& tolerance, Verification& result) {
  constexpr double kReach = 0.008;  // metres outside
  constexpr int kHalfWindow_px = 5;
  const std::array<cv::Point, 4> sides{cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}};
  for (int y = 0; y < rendered.rows; ++y) {
    for (int x = 0; x < rendered.cols; ++x) {
      const cv::Point at(x, y);
      if (!is_model(rendered, at)) continue;
      const float z = rendered.at<float>(at);
      for (const cv::Point& side : sides) {
        if (is_model(rendered, at + side)) continue;
        const int reach_px = 1 + kHalfWindow_px + static_cast<int>(kReach / frame.camera.metres_per_px(z));
        compare_beyond(frame, rendered, region.tl(), at, reach_px * side, static_cast<float>(tolerance.at(z)), result);
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
