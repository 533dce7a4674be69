#include "pose/verification/verification.hpp"

#include <array>
#include <cmath>
#include <optional>

#include "pipeline/base/no_value.hpp"
#include "pipeline/geometry/boundary_sample.hpp"
#include "pipeline/geometry/renderer.hpp"

namespace houghstream {
namespace {

/// View of a rendered model, across whose boundary samples are taken.
struct BoundaryView {
  const RgbdFrame& frame;
  const cv::Mat& rendered;  ///< depth, metres; NaN beside the model
  cv::Point origin_px;      ///< its first pixel in the frame
  const LabRegion* colours;

  bool is_model(const cv::Point& at) const {
    return at.x >= 0 && at.y >= 0 && at.x < rendered.cols && at.y < rendered.rows && !std::isnan(model(at));
  }
  float model(const cv::Point& at) const { return rendered.at<float>(at); }
  float measured(const cv::Point& at) const { return frame.depth.at<float>(at + origin_px); }
  bool is_in_frame(const cv::Point& at) const {
    return cv::Rect(cv::Point(), frame.depth.size()).contains(at + origin_px);
  }
};

/// Returns 0 where colours are not known; nothing where they are known of other positions only.
std::optional<float> colour_difference_sq(const BoundaryView& view, const cv::Point& inside, const cv::Point& beyond) {
  if (view.colours == nullptr || view.colours->lab.empty()) return 0.0F;
  const cv::Mat& lab = view.colours->lab;
  const cv::Point origin = view.colours->origin_px - view.origin_px;
  const cv::Rect part(origin, lab.size());
  if (!part.contains(inside) || !part.contains(beyond)) return std::nullopt;
  return colour_distance_sq(lab.at<cv::Vec3b>(inside - origin), lab.at<cv::Vec3b>(beyond - origin));
}

/// Samples the scene from the boundary pixel `at` towards `side`. Returns nothing where the sample is not informative:
/// across a notch, beside the frame, or behind another object.
std::optional<BoundarySample> sample_boundary(const BoundaryView& view, const cv::Point& at, const cv::Point& side,
                                              const DepthTolerance& tolerance) {
  constexpr double kInside = 0.004;  // metres: not on the edge, whose depth and colour are mixed
  constexpr double kBeyond = 0.008;
  const double metres_per_px = view.frame.camera.metres_per_px(view.model(at));
  const int in_px = 1 + static_cast<int>(kInside / metres_per_px);
  const int out_px = 1 + static_cast<int>(kBeyond / metres_per_px);
  const cv::Point inside = at - in_px * side;
  const cv::Point before = inside - 2 * in_px * side;
  const cv::Point beyond = at + out_px * side;
  if (!view.is_model(inside) || view.is_model(beyond) || !view.is_in_frame(beyond)) return std::nullopt;
  const float inside_depth = view.measured(inside);
  if (inside_depth < view.model(inside) - static_cast<float>(tolerance.at(view.model(inside)))) return std::nullopt;
  const std::optional<float> colour_sq = colour_difference_sq(view, inside, beyond);
  if (!colour_sq) return std::nullopt;
  BoundarySample sample;
  const auto steps = static_cast<float>(in_px + out_px);
  sample.lateral_distance = steps * static_cast<float>(metres_per_px);
  sample.depth_change = view.measured(beyond) - inside_depth;
  const float slope = view.is_model(before) ? view.model(inside) - view.model(before) : kNoValue;
  sample.expected_depth_change = slope * steps / static_cast<float>(2 * in_px);
  sample.colour_sq = *colour_sq;
  return sample;
}

/// Takes samples to the left and right of each row's boundary, and above and below each column's.
void compare_boundary(const BoundaryView& view, const DepthTolerance& tolerance, Verification& result) {
  const std::array<cv::Point, 4> sides{cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}};
  for (int y = 0; y < view.rendered.rows; ++y) {
    for (int x = 0; x < view.rendered.cols; ++x) {
      const cv::Point at(x, y);
      if (std::isnan(view.model(at))) continue;
      const auto limit = static_cast<float>(tolerance.at(view.model(at)));
      for (const cv::Point& side : sides) {
        if (view.is_model(at + side)) continue;
        const std::optional<BoundarySample> sample = sample_boundary(view, at, side, tolerance);
        if (!sample || is_foreground_step(*sample, limit)) continue;
        ++result.boundary_samples;
        result.boundary_continuations += surface_continuation(*sample, limit) * textured_colour_continuation(*sample);
      }
    }
  }
}

}  // namespace

float Verification::visible_fraction() const {
  return rendered == 0 ? 0.0F : static_cast<float>(depth_inliers) / static_cast<float>(rendered);
}

float Verification::free_space_violation() const {
  return rendered == 0 ? 0.0F : static_cast<float>(free_space_violations) / static_cast<float>(rendered);
}

Verification verify_projected_view(const ProjectedView& projected, const DepthTolerance& tolerance) {
  constexpr float kEdge = 0.3F;  // cosine between normal and line of sight
  Verification result;
  for (std::size_t i = 0; i < projected.points.size(); ++i) {
    const Eigen::Vector3f point = projected.T * projected.view.points[i];
    const Eigen::Vector3f normal = projected.T.linear() * projected.view.normals[i];
    if (!(-normal.dot(point) > kEdge * point.norm())) continue;
    ++result.rendered;
    const auto limit = static_cast<float>(tolerance.at(point.z()));
    const float difference =
        projected.points[i].depth_difference;  // NaN where nothing was measured: no comparison holds
    result.depth_inliers += std::abs(difference) <= limit ? 1 : 0;
    result.free_space_violations += difference > limit ? 1 : 0;
    result.occluded += difference < -limit ? 1 : 0;
  }
  return result;
}

Verification verify_pose(const RgbdFrame& frame, const Mesh& mesh, const Eigen::Isometry3d& T_camera_object,
                         const DepthTolerance& tolerance, const LabRegion* colours) {
  Verification result;
  const RenderedRegion part = render_depth_region(mesh, T_camera_object, frame.camera);
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
      const float difference = measured[x] - model[x];  // NaN where nothing was measured: no comparison holds
      result.depth_inliers += std::abs(difference) <= limit ? 1 : 0;
      result.free_space_violations += difference > limit ? 1 : 0;
      result.occluded += difference < -limit ? 1 : 0;
    }
  }
  compare_boundary({frame, rendered, region.tl(), colours}, tolerance, result);
  return result;
}

}  // namespace houghstream
