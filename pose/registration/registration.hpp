#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "pipeline/base/settings_fields.hpp"
#include "pose/registration/candidates.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

/// A candidate after registration with its evidence.
struct RegistrationResult {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  bool converged = false;  ///< the last step was small; false too where there were not enough pairs for a step
  int iterations = 0;
  int inliers = 0;  ///< model points with a measured point within the last correspondence distance
  float inlier_fraction = 0.0F;
  float residual = std::numeric_limits<float>::quiet_NaN();  ///< RMS distance of the inliers along normals, metres
};

/// Maximum correspondence distances of a registration, which shrink from start to end, metres.
struct RegistrationStage {
  int iterations = 0;
  int points = 0;  ///< maximum number of points of the model's view
  double max_correspondence_start_m = 0.0;
  double max_correspondence_end_m = 0.0;
  int search_steps = 2;  ///< ours: measured points looked at to each side of a model point's pixel
};

struct RegistrationSettings;

/// Registers the model of a seen object to the measured depth, from one start. Has no memory of its own; may be called
/// from several threads at once.
using RegistrationEngine = RegistrationResult (*)(const ObjectObservation& observation,
                                                  const Eigen::Isometry3d& T_camera_object,
                                                  const RegistrationStage& stage, const RegistrationSettings& settings);

/// Registers by our ICP: each visible model point is paired with the nearest measured point about its pixel (projective
/// data association, Blais & Levine 1995), and one step of Gauss-Newton lowers the distances along the model's normals
/// (Chen & Medioni 1992) under Tukey's weights. What lies in front of the model or behind it finds no pair.
RegistrationResult register_projective(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                       const RegistrationStage& stage, const RegistrationSettings& settings);

/// Point-to-plane registration with Tukey's weights (Rusinkiewicz & Levoy 2001).
struct RegistrationSettings {
  RegistrationEngine engine = register_projective;  ///< a study may set another (pose/baseline)
  int coarse_iterations = 8;
  int coarse_points = 120;
  int fine_iterations = 10;
  int fine_points = 600;
  double max_correspondence_start_m = 0.035;  ///< pairs farther apart have no weight; shrinks with every iteration
  double max_correspondence_end_m = 0.008;    ///< 3 sigma is added
  double point_weight = 0.1;                  ///< weight of the distance along the surface beside that across it
  double max_shift_m = 0.07;    ///< distance from the detected centre; a result farther away is another object
  double converged_m = 0.0005;  ///< last step moved the model's surface by less
};

template <typename Visit>
void fields(const RegistrationSettings& /*settings*/, const Visit& visit) {
  using S = RegistrationSettings;
  visit(number("coarse_iterations", &S::coarse_iterations, 0, 1000));
  visit(number("coarse_points", &S::coarse_points, 1, 100000));
  visit(number("fine_iterations", &S::fine_iterations, 0, 1000));
  visit(number("fine_points", &S::fine_points, 1, 100000));
  visit(number("max_correspondence_start_m", &S::max_correspondence_start_m, 0, 1, "m"));
  visit(number("max_correspondence_end_m", &S::max_correspondence_end_m, 0, 1, "m"));
  visit(number("point_weight", &S::point_weight, 0, 1));
  visit(number("max_shift_m", &S::max_shift_m, 0, 10, "m"));
  visit(number("converged_m", &S::converged_m, 0, 1, "m"));
}

/// Correspondence distances at which coarse registration of an object begins and all registration of it ends, metres:
/// the settings' and what depth's noise adds where the object is.
struct CorrespondenceDistances {
  double start = 0.0;
  double end = 0.0;
};
CorrespondenceDistances correspondence_distances(const ObjectObservation& observation,
                                                 const RegistrationSettings& settings);

/// Registers with few points, from pairs `start_m` apart on.
RegistrationResult register_coarsely(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                     double start_m, const RegistrationSettings& settings);

/// Registers with few points a rotation of a pose that was registered already: from pairs halfway between both
/// distances on.
RegistrationResult register_rotated(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                                    const RegistrationSettings& settings);

/// Registers with many points from where another registration ended; returns that one's result where this one leads too
/// far away. Counts the iterations of both.
RegistrationResult register_finely(const ObjectObservation& observation, const RegistrationResult& result,
                                   const RegistrationSettings& settings);

/// Returns whether the result is where the detection is.
bool is_near_detection(const ObjectObservation& observation, const RegistrationResult& result,
                       const RegistrationSettings& settings);

/// Registers every candidate coarsely, in their order.
std::vector<RegistrationResult> register_candidates(const ObjectObservation& observation,
                                                    const std::vector<PoseCandidate>& candidates,
                                                    const RegistrationSettings& settings);

}  // namespace houghstream
