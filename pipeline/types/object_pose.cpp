#include "pipeline/types/object_pose.hpp"

#include <algorithm>

namespace houghstream {
const char* to_string(PoseStatus status) {
  switch (status) {
    case PoseStatus::kInvalid: return "invalid";
    case PoseStatus::kValid: return "valid";
    case PoseStatus::kNoModel: return "no model";
    case PoseStatus::kTooFewPoints: return "too few points";
    case PoseStatus::kNoInitialPose: return "no initial pose";
    case PoseStatus::kNotConverged: return "not converged";
    case PoseStatus::kRejectedByDepth: return "rejected by depth";
    case PoseStatus::kLowScore: return "low score";
    case PoseStatus::kRejectedByOutline: return "rejected by outline";
    case PoseStatus::kRejectedByColour: return "rejected by colour";
    case PoseStatus::kOccluded: return "occluded";
    case PoseStatus::kRefuted: return "refuted";
    case PoseStatus::kValidUpToSymmetry: return "valid up to its shape's symmetry";
  }
  return "unknown";
}

const ObjectPose* find_pose(const ObjectPoses& poses, std::size_t detection_index) {
  const auto found = std::find_if(poses.poses.begin(), poses.poses.end(), [&](const ObjectPose& pose) {
    return pose.detection_index == static_cast<int>(detection_index);
  });
  return found == poses.poses.end() ? nullptr : &*found;
}

bool is_reported(const Detection& detection, const ObjectPose* pose) {
  if (pose == nullptr) return detection.reported;
  return has_pose(pose->status) || (detection.reported && pose->status != PoseStatus::kRefuted);
}

}  // namespace houghstream
