#include "pipeline/types/object_pose.hpp"

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
  }
  return "unknown";
}

}  // namespace houghstream
