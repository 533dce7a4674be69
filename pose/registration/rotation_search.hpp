#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "pose/seen/region.hpp"

namespace houghstream {

/// A pose and how depth and colour speak for it: joint_score, of a thin object on a plane times the share of its points
/// on the foreground.
struct ScoredPose {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  float score = 0.0F;
};

/// Scores a pose at the first `points` points of the view nearest to it.
ScoredPose score_pose_jointly(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                              int points, const DepthTolerance& tolerance);

/// Range of the turns that are tried, and the number that is wanted.
struct RotationRange {
  double step_rad = 0.0;
  double reach_rad = 0.0;  ///< reach to each side
  std::size_t maximum = 1;
  int points = 0;  ///< points of a view
};

/// Returns the pose turned about the object's z axis, through the middle of its surface; those turns that are better
/// than their neighbours, best first. Views of a standing object are most easily confused that way, and of a round one
/// only its texture tells them apart.
std::vector<ScoredPose> best_rotations_about_z(const ObjectObservation& observation,
                                               const Eigen::Isometry3d& T_camera_object, const RotationRange& range,
                                               const DepthTolerance& tolerance);

/// Small steps: turns about the object's z axis and shifts along its axes.
struct HillClimb {
  double step_rad = 0.0;
  double step_m = 0.0;
  int rounds = 0;  ///< rounds of one step each way; it is halved after a round without a better pose
  int points = 0;  ///< points of a view
};

/// Climbs from the pose by such steps to what neither depth alone nor a coarse turn settles, such as how far a printed
/// round object stands along its axis.
ScoredPose hill_climb_pose(const ObjectObservation& observation, const Eigen::Isometry3d& T_camera_object,
                           const HillClimb& hill_climb, const DepthTolerance& tolerance);

}  // namespace houghstream
