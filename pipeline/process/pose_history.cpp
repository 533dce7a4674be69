#include "pipeline/process/pose_history.hpp"

#include <algorithm>

namespace houghstream {
namespace {

bool share_a_class(const ObjectPoses& poses, const Detections& detections) {
  return std::any_of(poses.poses.begin(), poses.poses.end(), [&](const ObjectPose& pose) {
    return std::any_of(detections.detections.begin(), detections.detections.end(),
                       [&](const Detection& detection) { return detection.class_name == pose.class_name; });
  });
}

}  // namespace

ObjectPoses PoseHistory::before(const Detections& detections) const {
  const auto camera = cameras_.find(detections.frame.channel);
  if (camera == cameras_.end()) return {};
  const std::deque<ObjectPoses>& kept = camera->second;
  if (detectors_.of(detections.frame.channel) == 1) return kept.back();
  const auto found = std::find_if(kept.rbegin(), kept.rend(), [&](const ObjectPoses& poses) {
    return poses.frame.utime < detections.frame.utime && share_a_class(poses, detections);
  });
  return found == kept.rend() ? ObjectPoses{} : *found;
}

void PoseHistory::keep(const ObjectPoses& poses) {
  constexpr std::size_t kResults = 16;
  std::deque<ObjectPoses>& kept = cameras_[poses.frame.channel];
  kept.push_back(poses);
  if (kept.size() > kResults) kept.pop_front();
  detectors_.note_result(poses.frame);
}

}  // namespace houghstream
