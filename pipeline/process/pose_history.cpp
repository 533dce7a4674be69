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

std::vector<std::string> PoseHistory::note_classes(const Detections& detections, std::int64_t frame_number) {
  constexpr std::size_t kFrames = 16;
  std::set<std::string> names;
  for (const Detection& detection : detections.detections) names.insert(detection.class_name);
  const auto known = std::find_if(classes_.begin(), classes_.end(),
                                  [&](const FrameClasses& classes) { return classes.frame == detections.frame; });
  if (known == classes_.end()) {
    classes_.push_back({detections.frame, frame_number, std::move(names)});
    if (classes_.size() > kFrames) classes_.pop_front();
    return {};
  }
  if (known->number != frame_number) {
    detectors_.forget(detections.frame);
    *known = {detections.frame, frame_number, std::move(names)};
    return {};
  }
  std::vector<std::string> found_twice;
  for (const std::string& name : names) {
    if (!known->names.insert(name).second) found_twice.push_back(name);
  }
  return found_twice;
}

ObjectPoses PoseHistory::find_warm_start(const Detections& detections) const {
  const auto camera = cameras_.find(detections.frame.channel);
  if (camera == cameras_.end()) return {};
  const std::deque<ObjectPoses>& kept = camera->second;
  if (detectors_.of(detections.frame.channel) == 1) return kept.back();
  const auto found = std::find_if(kept.rbegin(), kept.rend(), [&](const ObjectPoses& poses) {
    return poses.frame.utime < detections.frame.utime && share_a_class(poses, detections);
  });
  return found == kept.rend() ? ObjectPoses{} : *found;
}

void PoseHistory::add(const ObjectPoses& poses) {
  constexpr std::size_t kResults = 16;
  std::deque<ObjectPoses>& kept = cameras_[poses.frame.channel];
  kept.push_back(poses);
  if (kept.size() > kResults) kept.pop_front();
  detectors_.note_result(poses.frame);
}

}  // namespace houghstream
