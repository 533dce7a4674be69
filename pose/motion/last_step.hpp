#pragma once

#include <Eigen/Geometry>

namespace houghstream {

/// Holds the last step of a camera about an object, or of an object before a camera: two poses T_camera_object, one
/// frame apart. The next frame is searched where the same step leads again.
struct LastStep {
  Eigen::Isometry3d T_last = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_before = Eigen::Isometry3d::Identity();

  /// Begins at a pose, at rest.
  void restart(const Eigen::Isometry3d& T) { T_last = T_before = T; }

  /// Takes the next frame's pose.
  void advance(const Eigen::Isometry3d& T) {
    T_before = T_last;
    T_last = T;
  }

  /// Replaces the last pose by a better one, and leaves the camera's step unchanged.
  void correct(const Eigen::Isometry3d& T) {
    T_before = T_before * T_last.inverse() * T;
    T_last = T;
  }

  /// Returns the pose after a repetition of the camera's step.
  Eigen::Isometry3d repeat_of_camera() const { return T_last * T_before.inverse() * T_last; }

  /// Returns the pose after a repetition of the object's step. Up to rounding it equals the camera's.
  Eigen::Isometry3d repeat_of_object() const { return T_last * (T_before.inverse() * T_last); }
};

}  // namespace houghstream
