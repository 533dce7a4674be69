#pragma once

#include <vector>

#include "pose/colour_score.hpp"

namespace houghstream {

/// A pose and how depth and colour speak for it (joint_score).
struct ScoredPose {
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  float score = 0.0F;
};

ScoredPose judge_pose(const RgbdFrame& frame, const LabRegion& colours, const ObjectModel& model,
                      const Eigen::Isometry3d& T_camera_object, int points, const DepthTolerance& tolerance);

/// Which turns are tried, and how many of them are wanted.
struct TurnRange {
  double step_rad = 0.0;
  double reach_rad = 0.0;  ///< to each side
  std::size_t most = 1;
  int points = 0;  ///< of a view
};

/// The pose turned about the object's z axis, through the middle of its surface; those turns that are better than their
/// neighbours, best first. Views of a standing object are most easily confused that way, and of a round one only its
/// print tells them apart.
std::vector<ScoredPose> best_turns(const RgbdFrame& frame, const LabRegion& colours, const ObjectModel& model,
                                   const Eigen::Isometry3d& T_camera_object, const TurnRange& range,
                                   const DepthTolerance& tolerance);

}  // namespace houghstream
