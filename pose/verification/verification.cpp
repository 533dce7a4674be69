#include "pose/verification/verification.hpp"

#include <array>
#include <cmath>

#include "pipeline/geometry/renderer.hpp"

namespace houghstream {
namespace {

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
  const RenderedPart part = render_depth_part(mesh, T_camera_object, frame.camera);
  const cv::Rect& region = part.region_px;
  if (region.area() == 0) return result;
  const cv::Mat& rendered = part.depth;
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
