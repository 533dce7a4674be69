#include "pose/verification/shared_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/geometry/renderer.hpp"

namespace houghstream {
namespace {

// Fraction of the tolerance within which two surfaces coincide: what lies flat on another thing must not.
constexpr float kCoincident = 0.25F;

/// Returns the fraction of the points of one model's view that lie in the other's bounding box, a little enlarged.
float fraction_inside(const PlacedModel& one, const PlacedModel& other) {
  constexpr float kMargin = 0.005F;  // metres: the error of a pose
  constexpr std::size_t kPoints = 100;
  const ModelView& view = nearest_view(one.model, one.T_camera_object);
  Eigen::AlignedBox3f box = mesh_bounds(other.model.mesh);
  box.min().array() -= kMargin;
  box.max().array() += kMargin;
  const Eigen::Isometry3f T_other_one = (other.T_camera_object.inverse() * one.T_camera_object).cast<float>();
  const std::size_t count = std::min(kPoints, view.points.size());
  std::size_t inside = 0;
  for (std::size_t i = 0; i < count; ++i) inside += box.contains(T_other_one * view.points[i]) ? 1 : 0;
  return count == 0 ? 0.0F : static_cast<float>(inside) / static_cast<float>(count);
}

/// Returns whether a large part of one of the models may lie where the other is.
bool can_overlap(const PlacedModel& a, const PlacedModel& b) {
  constexpr float kMinFraction = 0.25F;
  const Eigen::Vector3d between =
      a.T_camera_object * a.model.centre.cast<double>() - b.T_camera_object * b.model.centre.cast<double>();
  if (between.norm() > a.model.radius + b.model.radius) return false;
  return fraction_inside(a, b) >= kMinFraction || fraction_inside(b, a) >= kMinFraction;
}

}  // namespace

float shared_surface(const RgbdFrame& frame, const PlacedModel& a, const PlacedModel& b,
                     const DepthTolerance& tolerance) {
  if (!can_overlap(a, b)) return 0.0F;
  const RenderedRegion first = render_depth_region(a.model.mesh, a.T_camera_object, frame.camera);
  const RenderedRegion second = render_depth_region(b.model.mesh, b.T_camera_object, frame.camera);
  const cv::Rect both = first.region_px | second.region_px;
  int explained_first = 0;
  int explained_second = 0;
  int shared = 0;
  for (int y = both.y; y < both.br().y; ++y) {
    for (int x = both.x; x < both.br().x; ++x) {
      const float measured = frame.depth.at<float>(y, x);
      const float first_depth = first.depth_at({x, y});
      const float second_depth = second.depth_at({x, y});
      const auto limit = static_cast<float>(tolerance.at(measured));
      const bool is_first = std::abs(measured - first_depth) <= limit;  // false for NaN
      const bool is_second = std::abs(measured - second_depth) <= limit;
      explained_first += is_first ? 1 : 0;
      explained_second += is_second ? 1 : 0;
      shared += is_first && is_second && std::abs(first_depth - second_depth) <= kCoincident * limit ? 1 : 0;
    }
  }
  const int fewer = std::min(explained_first, explained_second);
  return fewer == 0 ? 0.0F : static_cast<float>(shared) / static_cast<float>(fewer);
}

void ExplainedSurface::add(const PlacedModel& placed) {
  const ModelView& view = nearest_view(placed.model, placed.T_camera_object);
  parts_.push_back({&view, placed.T_camera_object.inverse().cast<float>(), placed.model.centre, placed.model.radius});
}

float ExplainedSurface::fraction_of(const RgbdFrame& frame, const PlacedModel& placed,
                                    const DepthTolerance& tolerance) const {
  constexpr int kPoints = 250;
  constexpr float kNear = 0.5F;  // fraction of the tolerance: wider than kCoincident, since the pose is a first one
  const ProjectedView projected = project_view(frame, placed.model, placed.T_camera_object, kPoints);
  int inliers = 0;
  int shared = 0;
  for (std::size_t i = 0; i < projected.points.size(); ++i) {
    const Eigen::Vector3f point = projected.T * projected.view.points[i];
    const auto limit = static_cast<float>(tolerance.at(point.z()));
    if (!(std::abs(projected.points[i].depth_difference) <= limit)) continue;  // NaN where nothing was measured
    ++inliers;
    const auto contains = [&](const Part& part) { return part.contains(point, kNear * limit); };
    shared += std::any_of(parts_.begin(), parts_.end(), contains) ? 1 : 0;
  }
  return inliers == 0 ? 0.0F : static_cast<float>(shared) / static_cast<float>(inliers);
}

/// Returns whether a point lies within `limit` metres of the surface, which continues flat about each point of the view
/// for about as far as it is to the next ones.
bool ExplainedSurface::Part::contains(const Eigen::Vector3f& point_camera, float limit) const {
  constexpr float kSpacing = 0.15F;  // radii
  const Eigen::Vector3f point = T_model_camera * point_camera;
  if ((point - centre).norm() > radius + limit) return false;
  float min_sq = std::numeric_limits<float>::infinity();
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < view->points.size(); ++i) {
    const float distance_sq = (view->points[i] - point).squaredNorm();
    if (distance_sq < min_sq) {
      min_sq = distance_sq;
      nearest = i;
    }
  }
  const float reach = kSpacing * radius + limit;
  return min_sq <= reach * reach && std::abs(view->normals[nearest].dot(point - view->points[nearest])) <= limit;
}

}  // namespace houghstream
