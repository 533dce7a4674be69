#include "pose/depth_score.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace

DepthScore score_pose(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                      int points, const DepthTolerance& tolerance) {
  const ModelView& view = nearest_view(model, T_camera_object);
  const std::size_t count = std::min<std::size_t>(points, view.points.size());
  DepthScore score;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d point = T_camera_object * view.points[i].cast<double>();
    const auto beyond = static_cast<float>(depth_beyond(frame, point) / tolerance.at(point.z()));
    if (std::abs(beyond) <= 1.0F) {
      score.agreeing += 1.0F - beyond * beyond;
    } else if (beyond > 1.0F) {
      score.violating += std::min(1.0F, beyond - 1.0F);
    }
  }
  score.agreeing /= static_cast<float>(count);
  score.violating /= static_cast<float>(count);
  score.value = (score.agreeing - score.violating) * view.area;
  return score;
}

double best_depth_shift(const RgbdFrame& frame, const ObjectModel& model, const Eigen::Isometry3d& T_camera_object,
                        int points, double reach, const DepthTolerance& tolerance) {
  const ModelView& view = nearest_view(model, T_camera_object);
  const std::size_t count = std::min<std::size_t>(points, view.points.size());
  std::vector<float> shifts;
  shifts.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float beyond = depth_beyond(frame, T_camera_object * view.points[i].cast<double>());
    if (std::abs(beyond) <= reach) shifts.push_back(beyond);
  }
  std::sort(shifts.begin(), shifts.end());
  const auto width = static_cast<float>(tolerance.at(T_camera_object.translation().z()));
  std::size_t best_first = 0;
  std::size_t best_count = 0;
  std::size_t last = 0;
  for (std::size_t first = 0; first < shifts.size(); ++first) {
    while (last < shifts.size() && shifts[last] <= shifts[first] + width) ++last;
    if (last - first > best_count) {
      best_count = last - first;
      best_first = first;
    }
  }
  if (best_count == 0) return 0.0;
  double sum = 0.0;
  for (std::size_t i = best_first; i < best_first + best_count; ++i) sum += shifts[i];
  return sum / static_cast<double>(best_count);
}

}  // namespace houghstream
