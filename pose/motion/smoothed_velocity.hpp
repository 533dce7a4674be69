#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace houghstream {

/// Estimates the velocity of an object in its camera's frame, about a point (twist.hpp): each measured step moves it by
/// a fraction of the difference. It has no uncertainty, since each pose is measured again; an estimated pose has a
/// MotionFilter.
class SmoothedVelocity {
 public:
  /// Returns the pose after `seconds` at this velocity.
  Eigen::Isometry3d predict(const Eigen::Isometry3d& T_camera_object, double seconds) const;

  /// Takes a step of `seconds`, more than 0. At gain 1 its velocity takes the place of the one before.
  void update(const Eigen::Isometry3d& T_before, const Eigen::Isometry3d& T_after, double seconds, double gain);

  /// Keeps of its rotation only what `observed` leaves of it: a rotation that nothing measures would confirm itself, as
  /// each pose begins where the one before predicts it.
  void limit_rotation(const Eigen::Matrix3d& observed) { angular_velocity_ = observed * angular_velocity_; }

  /// Sets the velocity to zero.
  void reset();

  bool is_zero() const;

  const Eigen::Vector3d& linear_velocity() const { return linear_velocity_; }    ///< velocity of the origin, m/s
  const Eigen::Vector3d& angular_velocity() const { return angular_velocity_; }  ///< rad/s

 private:
  Eigen::Vector3d linear_velocity_ = Eigen::Vector3d::Zero();   // m/s
  Eigen::Vector3d angular_velocity_ = Eigen::Vector3d::Zero();  // rad/s
};

/// Returns the pose after the motion on which two of `motions` agree (8 mm, 0.04 radians, at this pose), which is the
/// camera's own as far as it can be determined. Motions are in the camera's frame: T_after * T_before^-1 of other
/// objects. Returns nothing where no two agree.
std::optional<Eigen::Isometry3d> predict_by_camera_motion(const Eigen::Isometry3d& T_camera_object,
                                                          const std::vector<Eigen::Isometry3d>& motions);

}  // namespace houghstream
