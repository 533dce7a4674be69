#include "pose/motion/motion_filter.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "pipeline/types/frame_id.hpp"
#include "pose/motion/twist.hpp"

namespace houghstream {
namespace {

Vector6 both(double translation, double rotation) {
  Vector6 out;
  out << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
  return out;
}

}  // namespace

MotionFilter::MotionFilter(const PoseMeasurement& first, const MotionSettings& settings)
    : settings_(settings), utime_(first.utime), measured_utime_(first.utime), T_(first.T_world_object) {
  P_.topLeftCorner<6, 6>() = first.covariance;
  consider_.topRows<6>() = consider_covariance(first);
}

/// Returns a square root of the common part of its covariance. It is the symmetric one, so that it rotates with the
/// line of sight.
Covariance6 MotionFilter::consider_covariance(const PoseMeasurement& measured) const {
  const Eigen::SelfAdjointEigenSolver<Covariance6> solver(settings_.common_variance_fraction * measured.covariance);
  const Vector6 deviations = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  return solver.eigenvectors() * deviations.asDiagonal() * solver.eigenvectors().transpose();
}

void MotionFilter::predict(std::int64_t utime) {
  if (utime <= utime_) return;
  const double dt = seconds_between(utime_, utime);
  const double coasts = std::clamp(settings_.coast_s - seconds_between(measured_utime_, utime_), 0.0, dt);
  utime_ = utime;
  if (!moving_) {
    const Vector6 drift = both(settings_.drift_m, settings_.drift_rad);
    P_.diagonal().head<6>() += dt * drift.cwiseProduct(drift);
    return;
  }
  T_ = retract_about_world(T_, coasts * velocity_);
  Matrix12 F = Matrix12::Identity();
  F.topRightCorner<6, 6>().diagonal().setConstant(dt);
  P_ = F * P_ * F.transpose();
  consider_ = F * consider_;
  const Vector6 density = both(settings_.acceleration, settings_.angular_acceleration);
  P_.diagonal().head<6>() += dt * dt * dt / 3.0 * density;
  P_.topRightCorner<6, 6>().diagonal() += dt * dt / 2.0 * density;
  P_.bottomLeftCorner<6, 6>().diagonal() += dt * dt / 2.0 * density;
  P_.diagonal().tail<6>() += dt * density;
}

void MotionFilter::update(const PoseMeasurement& measured) {
  measured_utime_ = std::max(measured_utime_, measured.utime);
  const Covariance6 S = P_.topLeftCorner<6, 6>() + measured.covariance;
  const Matrix12x6 gain = P_.leftCols<6>() * S.inverse();
  const Eigen::Matrix<double, 12, 1> step = gain * local_coordinates_about_world(measured.T_world_object, T_);
  T_ = retract_about_world(T_, step.head<6>());
  const Covariance6 unlike = consider_covariance(measured) - consider_.topRows<6>();
  consider_ += gain * unlike;
  P_ -= gain * P_.topRows<6>();
  P_ = 0.5 * (P_ + P_.transpose()).eval();
  if (moving_) velocity_ += step.tail<6>();
}

void MotionFilter::start_moving(const PoseMeasurement& measured, const Vector6& velocity) {
  constexpr double kVelocity = 0.2;         // m/s: how well it is known
  constexpr double kAngularVelocity = 1.0;  // rad/s
  moving_ = true;
  utime_ = std::max(utime_, measured.utime);
  measured_utime_ = measured.utime;
  T_ = measured.T_world_object;
  velocity_ = velocity;
  P_.setZero();
  P_.topLeftCorner<6, 6>() = measured.covariance;
  consider_.setZero();
  consider_.topRows<6>() = consider_covariance(measured);
  P_.diagonal().tail<6>() = both(kVelocity * kVelocity, kAngularVelocity * kAngularVelocity);
}

void MotionFilter::stop() {
  moving_ = false;
  velocity_.setZero();
  const Covariance6 pose = P_.topLeftCorner<6, 6>();
  P_.setZero();
  P_.topLeftCorner<6, 6>() = pose;
  consider_.bottomRows<6>().setZero();
}

}  // namespace houghstream
