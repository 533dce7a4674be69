#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pipeline/types/detection.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// A rotation on which votes agree.
struct RotationCandidate {
  Eigen::Quaternionf R_camera_object = Eigen::Quaternionf::Identity();
  float weight = 0.0F;  ///< of its votes, 0 for one that was added without votes
};

/// Modes of the votes' rotations, heaviest first: the vote with most weight about it gathers its neighbours, whose mean
/// (Markley et al. 2007) is a candidate; again with the rest. Then the heaviest turned by quarters about the
/// object's z axis, because views of a standing object are most easily confused that way.
/// Empty where the votes hold no finite rotation with weight.
std::vector<RotationCandidate> rotation_clusters(const std::vector<RotationVote>& votes,
                                                 const InitialSettings& settings);

/// How much the votes speak for a pose's rotation: weight of the modes about it, as near as the clusters are wide,
/// relative to the heaviest mode's, 0 to 1.
float vote_support(const std::vector<RotationCandidate>& votes, const Eigen::Isometry3d& T_camera_object,
                   const InitialSettings& settings);

}  // namespace houghstream
