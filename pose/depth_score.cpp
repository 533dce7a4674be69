#include "pose/depth_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace houghstream {
namespace {

/// Measured minus model depth along the ray of `point`; nothing where the image ends or has no depth (NaN).
float depth_beyond(const RgbdFrame& frame, const Eigen::Vector3d& point) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  if (!(point.z() > 0.0)) return kUnknown;
  const Eigen::Vector2d pixel = frame.camera.project(point) + Eigen::Vector2d::Constant(0.5);
  const bool inside =
      pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < frame.depth.cols && pixel.y() < frame.depth.rows;
  if (!inside) return kUnknown;
  return frame.depth.ptr<float>(static_cast<int>(pixel.y()))[static_cast<int>(pixel.x())] -
         static_cast<float>(point.z());
}

/// Per point measured minus model depth, NaN where unknown.
std::vector<float> depths_beyond(const RgbdFrame& frame, const ModelView& view,
                                 const Eigen::Isometry3d& T_camera_object, int points) {
  std::vector<float> beyond(std::min<std::size_t>(std::max(0, points), view.points.size()));
  for (std::size_t i = 0; i < beyond.size(); ++i) {
    beyond[i] = depth_beyond(frame, T_camera_object * view.points[i].cast<double>());
  }
  return beyond;
}

/// `width` is the tolerance at the object's depth.
DepthScore score_of(const std::vector<float>& beyond, float shift, float width, float area) {
  DepthScore score;
  for (const float value : beyond) {
    const float ratio = (value - shift) / width;
    if (std::abs(ratio) <= 1.0F) {
      score.agreeing += 1.0F - ratio * ratio;
    } else if (ratio > 1.0F) {
      score.violating += std::min(1.0F, ratio - 1.0F);
    }
  }
  score.agreeing /= static_cast<float>(beyond.size());
  score.violating /= static_cast<float>(beyond.size());
  score.value = (score.agreeing - score.violating) * area;
  return score;
}

/// Mean of the fullest window of `width` among the sorted values; 0 without values.
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

DepthScore score_pose(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                      int points, const DepthTolerance& tolerance) {
  const ModelView& view = nearest_view(model, T_camera_object);
  const auto width = static_cast<float>(tolerance.at(T_camera_object.translation().z()));
  return score_of(depths_beyond(frame, view, T_camera_object, points), 0.0F, width, view.area);
}

DepthShift best_depth_shift(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                            int points, double reach, const DepthTolerance& tolerance) {
  const ModelView& view = nearest_view(model, T_camera_object);
  const auto width = static_cast<float>(tolerance.at(T_camera_object.translation().z()));
  const std::vector<float> beyond = depths_beyond(frame, view, T_camera_object, points);
  std::vector<float> within;
  within.reserve(beyond.size());
  for (const float value : beyond) {
    if (std::abs(value) <= reach) within.push_back(value);  // false for NaN
  }
  std::sort(within.begin(), within.end());
  const float shift = densest_mean(within, width);
  return {shift, score_of(beyond, shift, width, view.area)};
}

}  // namespace houghstream
