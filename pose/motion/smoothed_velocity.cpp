#include "pose/motion/smoothed_velocity.hpp"

#include "pose/motion/twist.hpp"

namespace houghstream {
namespace {

bool is_near(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kNear = 0.008;  // metres
  constexpr double kAngle = 0.04;  // radians
  return (a.translation() - b.translation()).norm() < kNear &&
         rotation_vector(a.linear() * b.linear().transpose()).norm() < kAngle;
}

}  // namespace

Eigen::Isometry3d SmoothedVelocity::predict(const Eigen::Isometry3d& T_camera_object, double seconds) const {
  return retract_about_point(T_camera_object, seconds * linear_velocity_, seconds * angular_velocity_);
}

void SmoothedVelocity::update(const Eigen::Isometry3d& T_before, const Eigen::Isometry3d& T_after, double seconds,
                              double gain) {
  const Eigen::Vector3d speed = (T_after.translation() - T_before.translation()) / seconds;
  const Eigen::Vector3d angular_velocity = rotation_vector(T_after.linear() * T_before.linear().transpose()) / seconds;
  linear_velocity_ += gain * (speed - linear_velocity_);
  angular_velocity_ += gain * (angular_velocity - angular_velocity_);
}

void SmoothedVelocity::reset() {
  linear_velocity_ = angular_velocity_ = Eigen::Vector3d::Zero();
}

bool SmoothedVelocity::is_zero() const {
  return linear_velocity_.isZero(0.0) && angular_velocity_.isZero(0.0);
}

std::optional<Eigen::Isometry3d> predict_by_camera_motion(const Eigen::Isometry3d& T_camera_object,
                                                          const std::vector<Eigen::Isometry3d>& motions) {
  for (std::size_t i = 0; i < motions.size(); ++i) {
    for (std::size_t j = i + 1; j < motions.size(); ++j) {
      if (is_near(motions[i] * T_camera_object, motions[j] * T_camera_object)) return motions[i] * T_camera_object;
    }
  }
  return std::nullopt;
}

}  // namespace houghstream
