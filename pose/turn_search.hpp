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

/// The pose turned about the object's z axis, through the middle of its surface, by multiples of `step_rad` up to
/// `reach_rad` to each side; those that are better than their neighbours, best first, at most `most`. Views of a
/// standing object are most easily confused that way, and of a round one only its print tells them apart.
std::vector<ScoredPose> best_turns(const RgbdFrame& frame, const LabRegion& colours, const ObjectModel& model,
                                   const Eigen::Isometry3d& T_camera_object, double step_rad, double reach_rad,
                                   std::size_t most, int points, const DepthTolerance& tolerance);

}  // namespace houghstream
