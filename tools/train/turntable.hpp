#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "drivers/datasets/object_pixels.hpp"

namespace houghstream {

/// Object points of one view from a turntable.
struct TurntableView {
  double yaw = 0.0;                   ///< radians, as counted by the turntable; its direction is unknown
  std::vector<ColouredPoint> points;  ///< camera frame
};

/// A fixed camera that looks down at a turning object.
struct Turntable {
  /// Object frame at yaw 0: origin on the axis of rotation at half the object's height, z up, x to the camera's right.
  Eigen::Isometry3d T_camera_axis = Eigen::Isometry3d::Identity();
  double direction = 1.0;  ///< +1 where yaw turns the object counter-clockwise seen from above, else -1

  /// Returns T_camera_object when the table stands at `yaw`.
  Eigen::Isometry3d pose_at(double yaw) const;
};

/// Finds the axis, the camera's elevation and the direction from the points of one full turn. Needs at least one view;
/// views without points are ignored.
Turntable estimate_turntable(const std::vector<TurntableView>& views);

}  // namespace houghstream
