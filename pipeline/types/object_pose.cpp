#include "pipeline/types/object_pose.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/log_odds.hpp"

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

const ObjectPose* find_pose(const ObjectPoses& poses, std::size_t detection_index) {
  const auto found = std::find_if(poses.poses.begin(), poses.poses.end(), [&](const ObjectPose& pose) {
    return pose.detection_index == static_cast<int>(detection_index);
  });
  return found == poses.poses.end() ? nullptr : &*found;
}

float presence_probability(float score, float quality) {
  constexpr double kBias = 0.27;
  constexpr double kOfScore = 0.26;
  constexpr double kOfQuality = 0.68;
  const double sum = kBias + kOfScore * log_odds(score) + kOfQuality * log_odds(quality);
  return static_cast<float>(1.0 / (1.0 + std::exp(-sum)));
}

bool is_refuted(const Detection& detection, const ObjectPose* pose) {
  if (pose == nullptr) return false;
  switch (pose->status) {
    case PoseStatus::kRejectedByDepth:
    case PoseStatus::kLowScore:
    case PoseStatus::kRejectedByOutline:
    case PoseStatus::kRejectedByColour: return presence_probability(detection.score, pose->quality) < 0.5F;
    default: return false;  // valid, or none was found that could be judged
  }
}

bool is_reported(const Detection& detection, const ObjectPose* pose) {
  if (pose != nullptr && pose->status == PoseStatus::kValid) return true;
  return detection.reported && !is_refuted(detection, pose);
}

}  // namespace houghstream
