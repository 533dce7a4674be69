#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "pipeline/base/settings_fields.hpp"
#include "pipeline/types/tracked_object.hpp"

namespace houghstream {

/// Holds a measured pose of an object in the world.
struct PoseMeasurement {
  std::int64_t utime = 0;  ///< microseconds
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  Covariance6 covariance = Covariance6::Identity();
};

struct MotionSettings {
  double drift_m = 0.0002;            ///< random walk of a static object within a second, metres
  double drift_rad = 0.0024;          ///< drift of its rotation: together they average over some two seconds
  double acceleration = 1.0;          ///< spectral density of a moving object, m^2/s^3: a hand's
  double angular_acceleration = 8.0;  ///< rad^2/s^3
  double coast_s = 0.15;              ///< time for which a moving object continues without a measurement
  /// Fraction of a measurement's variance that the frames of a view have in common. Half of the errors of rendered
  /// frames are within 0.5 mm at 1 m; if these were Gaussian, and all in common, it would be 0.03. The default is three
  /// times that, since objects differ; it is chosen, not learnt.
  double common_variance_fraction = 0.1;
};

template <typename Visit>
void fields(const MotionSettings& /*settings*/, const Visit& visit) {
  using S = MotionSettings;
  visit(number("drift_m", &S::drift_m, 0, 1, "m"));
  visit(number("drift_rad", &S::drift_rad, 0, 3.2, "rad"));
  visit(number("acceleration", &S::acceleration, 0, 1e6, "m^2/s^3"));
  visit(number("angular_acceleration", &S::angular_acceleration, 0, 1e6, "rad^2/s^3"));
  visit(number("coast_s", &S::coast_s, 0, 3600, "s"));
  visit(number("common_variance_fraction", &S::common_variance_fraction, 0, 1));
}

/// Estimates the pose of one object over time by a Kalman filter on the group of motions (error state: twists about the
/// world's axes, twist.hpp). The pose of a static object is averaged: it hardly wanders, and it has no velocity. A
/// moving object has constant velocity under white acceleration (Bar-Shalom, Li and Kirubarajan 2001, section 6.2). The
/// owner of the filter decides which of the two applies.
///
/// Frames that show an object from the same side have the same errors (model, mesh and depth are the same), which no
/// average of them removes: of n measurements with the variance R, of which c R in common, the mean has c R + (1 - c) R
/// / n, not R / n. So the filter averages as if all of R were white, and also propagates the common error in its state,
/// as Schmidt's filter does for states that are considered and not estimated (Schmidt 1966): it is part of the
/// covariance. Errors of several cameras count as one, which overestimates rather than underestimates them.
class MotionFilter {
 public:
  MotionFilter(const PoseMeasurement& first, const MotionSettings& settings);

  /// Predicts the state at a time; one before the last does nothing.
  void predict(std::int64_t utime);

  /// Takes a measurement of the time that it was predicted to.
  void update(const PoseMeasurement& measured);

  /// Makes the object move from now on, at the measured pose and with this velocity, m/s and rad/s.
  void start_moving(const PoseMeasurement& measured, const Vector6& velocity);

  /// Makes the object static from now on, at its present pose.
  void stop();

  bool moving() const { return moving_; }
  std::int64_t utime() const { return utime_; }
  const Eigen::Isometry3d& T_world_object() const { return T_; }
  Vector6 velocity() const { return velocity_; }
  /// Returns the covariance of the pose, with the error that its measurements share.
  Covariance6 covariance() const {
    return P_.topLeftCorner<6, 6>() + consider_.topRows<6>() * consider_.topRows<6>().transpose();
  }

 private:
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  using Matrix12x6 = Eigen::Matrix<double, 12, 6>;

  Covariance6 consider_covariance(const PoseMeasurement& measured) const;

  MotionSettings settings_;
  bool moving_ = false;
  std::int64_t utime_ = 0;
  std::int64_t measured_utime_ = 0;
  Eigen::Isometry3d T_;
  Vector6 velocity_ = Vector6::Zero();
  Matrix12 P_ = Matrix12::Zero();             // covariance of pose, then velocity
  Matrix12x6 consider_ = Matrix12x6::Zero();  // effect of a common error of unit covariance on the state
};

}  // namespace houghstream
