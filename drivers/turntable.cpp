#include "drivers/turntable.hpp"

#include <cmath>

#include "pipeline/checks.hpp"

namespace houghstream {
namespace {

/// Camera axes of an upright object frame seen from `elevation` above the horizon (radians).
Eigen::Matrix3d upright_rotation(double elevation) {
  const double s = std::sin(elevation);
  const double c = std::cos(elevation);
  Eigen::Matrix3d R_camera_axis;
  R_camera_axis << 1.0, 0.0, 0.0,  //
      0.0, -s, -c,                 //
      0.0, c, -s;
  return R_camera_axis;
}

}  // namespace

Eigen::Isometry3d Turntable::T_camera_object(double yaw) const {
  return T_camera_axis * Eigen::AngleAxisd(direction * yaw, Eigen::Vector3d::UnitZ());
}

Turntable estimate_turntable(const std::vector<TurntableView>& views) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int used = 0;
  for (const TurntableView& view : views) {
    if (view.points.empty()) continue;
    Eigen::Vector3d low = view.points.front().position;
    Eigen::Vector3d high = low;
    for (const ColouredPoint& point : view.points) {
      low = low.cwiseMin(point.position);
      high = high.cwiseMax(point.position);
    }
    // Only the near side is seen: its far side lies about half a width behind.
    sum += 0.5 * (low + high) + Eigen::Vector3d(0.0, 0.0, 0.25 * (high.x() - low.x()));
    ++used;
  }
  require(used > 0, "turntable views without any depth on the object, expected some");
  constexpr double kAssumedElevation = 0.5;
  Turntable table;
  table.T_camera_axis.linear() = upright_rotation(kAssumedElevation);
  table.T_camera_axis.translation() = sum / used;
  return table;
}

}  // namespace houghstream
