#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>

#include "pose/registration/correspondence_block.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Normal equations of a small motion of a model: of its rotation about the model's centre times the model's radius,
/// and of its shift, both metres along the camera's axes. The minimum is at hessian^-1 gradient.
struct MotionEquations {
  Matrix6d hessian = Matrix6d::Zero();  ///< lower triangle
  Vector6d gradient = Vector6d::Zero();
};

/// Weighted sums of products over correspondences. Arms lead from the model's centre to the points, in its radius.
struct CorrespondenceSums {
  /// Products of (arm x normal, normal, residual along the normal, 0).
  OuterProductSum across = OuterProductSum::Zero();
  OuterProductSum along = OuterProductSum::Zero();  ///< products of (arm, 1, residual, 0)
  int count = 0;
  double squares = 0.0;  ///< sum of the squared distances along the normals, m^2
};

/// Returns the weight of a pair, 0 to 1, by its measured point, camera frame, metres.
using PairWeight = std::function<float(const Eigen::Vector3f&)>;

/// Finds the correspondences of the first `count` points of the view nearest to the pose, and sums them up under
/// Tukey's weights, times those of `weight` where it is given.
CorrespondenceSums sum_correspondences(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                       std::size_t count, const CorrespondenceSearch& search,
                                       const PairWeight& weight = nullptr);

/// Builds the normal equations of E = sum w ((n.r)^2 + point_weight r^2), where r leads from a model point to its
/// measured point (point-to-plane ICP, Chen & Medioni 1992).
MotionEquations build_equations(const CorrespondenceSums& totals, double point_weight);

/// Moves the model by a solution of its equations and returns the motion's length, metres.
double move_by_step(const Vector6d& step, const ObjectModel& model, Eigen::Isometry3d& T_camera_object);

}  // namespace houghstream
