#include "pose/seen/depth_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace houghstream {
namespace {

/// Scores a shifted view; `width` is the tolerance at the object's depth.
DepthScore score_of(const ProjectedView& projected, float shift, float width) {
  DepthScore score;
  for (const ProjectedPoint& point : projected.points) {
    const float ratio = (point.depth_difference - shift) / width;
    // The sum has no branches, since the case changes from point to point: NaN is not above 0 and adds nothing.
    score.inlier_fraction += std::max(0.0F, 1.0F - ratio * ratio);
    score.free_space_violation += std::min(1.0F, std::max(0.0F, ratio - 1.0F));
  }
  score.inlier_fraction /= static_cast<float>(projected.points.size());
  score.free_space_violation /= static_cast<float>(projected.points.size());
  score.value = (score.inlier_fraction - score.free_space_violation) * projected.view.area;
  return score;
}

/// Returns the mean of the fullest window of `width` among the sorted values; 0 without values.
float densest_mean(const std::vector<float>& sorted, float width) {
  std::size_t best_first = 0;
  std::size_t best_count = 0;
  std::size_t last = 0;
  for (std::size_t first = 0; first < sorted.size(); ++first) {
    while (last < sorted.size() && sorted[last] <= sorted[first] + width) ++last;
    if (last - first > best_count) {
      best_count = last - first;
      best_first = first;
    }
  }
  float sum = 0.0F;
  for (std::size_t i = best_first; i < best_first + best_count; ++i) sum += sorted[i];
  return best_count == 0 ? 0.0F : sum / static_cast<float>(best_count);
}

}  // namespace

ProjectedView project_view(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                           int points) {
  const double depth = (T_camera_object * model.centre.cast<double>()).z();
  ProjectedView result{nearest_view(model, T_camera_object), T_camera_object.cast<float>(), depth, {}};
  const auto columns = static_cast<float>(frame.depth.cols);
  const auto rows = static_cast<float>(frame.depth.rows);
  result.points.resize(std::min<std::size_t>(static_cast<std::size_t>(std::max(0, points)), result.view.points.size()));
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    const Eigen::Vector3f point = result.T * result.view.points[i];
    if (!(point.z() > 0.0F)) continue;
    const Eigen::Vector2f pixel = frame.camera.project_single(point) + Eigen::Vector2f::Constant(0.5F);
    if (!(pixel.x() >= 0.0F && pixel.y() >= 0.0F && pixel.x() < columns && pixel.y() < rows)) continue;
    ProjectedPoint& projected = result.points[i];
    projected.x = static_cast<int>(pixel.x());
    projected.y = static_cast<int>(pixel.y());
    projected.depth_difference = frame.depth.ptr<float>(projected.y)[projected.x] - point.z();
  }
  return result;
}

DepthScore score_projected_view(const ProjectedView& projected, const DepthTolerance& tolerance) {
  return score_of(projected, 0.0F, static_cast<float>(tolerance.at(projected.depth)));
}

DepthScore score_pose(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                      int points, const DepthTolerance& tolerance) {
  return score_projected_view(project_view(frame, model, T_camera_object, points), tolerance);
}

DepthShift best_depth_shift(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                            const ShiftSearch& search) {
  const ProjectedView projected = project_view(frame, model, T_camera_object, search.points);
  const auto width = static_cast<float>(search.tolerance.at(projected.depth));
  std::vector<float> within;
  within.reserve(projected.points.size());
  for (const ProjectedPoint& point : projected.points) {
    if (std::abs(point.depth_difference) <= search.reach_m) within.push_back(point.depth_difference);  // false for NaN
  }
  std::sort(within.begin(), within.end());
  const float shift = densest_mean(within, width);
  return {shift, score_of(projected, shift, width)};
}

}  // namespace houghstream
