#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "pose/registration/depth_equations.hpp"
#include "pose/registration/registration.hpp"

namespace houghstream {
namespace {

constexpr int kMinPairs = 12;  // minimum number of pairs for a step: twice the unknowns
// Fraction of the Hessian's mean diagonal; holds rotations that symmetric surfaces leave open.
constexpr double kDamping = 1e-3;

/// Moves the model by the damped Gauss-Newton step and returns the step's length, metres.
double apply_gauss_newton_step(MotionEquations equations, const ObjectModel& model,
                               Eigen::Isometry3d& T_camera_object) {
  const double damping = kDamping * equations.hessian.trace() / 6.0;
  equations.hessian.diagonal().array() += damping;
  const Vector6d step = equations.hessian.selfadjointView<Eigen::Lower>().ldlt().solve(equations.gradient);
  return step.allFinite() ? move_by_step(step, model, T_camera_object) : 0.0;
}

}  // namespace

RegistrationResult register_projective(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                       const RegistrationStage& stage, const RegistrationSettings& settings) {
  const ObjectModel& model = observation.model;
  RegistrationResult result;
  result.T_camera_object = T_camera_object;
  const auto points = static_cast<std::size_t>(stage.points);
  const double shrink = std::pow(stage.max_correspondence_end_m / stage.max_correspondence_start_m,
                                 1.0 / std::max(1, stage.iterations - 1));
  double distance = stage.max_correspondence_start_m;
  for (; result.iterations < stage.iterations; ++result.iterations) {
    const CorrespondenceSums pairs = sum_correspondences(observation, result.T_camera_object, points,
                                                         {static_cast<float>(distance), stage.search_steps});
    result.converged = false;
    if (pairs.count < kMinPairs) break;
    const MotionEquations equations = build_equations(pairs, settings.point_weight);
    result.converged = apply_gauss_newton_step(equations, model, result.T_camera_object) < settings.converged_m;
    if (result.converged && distance <= stage.max_correspondence_end_m * 1.01) break;
    distance = std::max(distance * shrink, stage.max_correspondence_end_m);
  }
  const CorrespondenceSums last =
      sum_correspondences(observation, result.T_camera_object, points,
                          {static_cast<float>(stage.max_correspondence_end_m), stage.search_steps});
  const std::size_t used = std::min(points, nearest_view(model, result.T_camera_object).points.size());
  result.inliers = last.count;
  result.inlier_fraction = static_cast<float>(last.count) / static_cast<float>(used);
  result.residual = static_cast<float>(std::sqrt(last.squares / last.count));  // 0/0 is NaN
  return result;
}

}  // namespace houghstream
