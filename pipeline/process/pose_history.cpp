#include "pipeline/process/pose_history.hpp"

#include <algorithm>

namespace houghstream {
namespace {

bool has_common_class(const ObjectPoses& poses, const Detections& detections) {
  return std::any_of(poses.poses.begin(), poses.poses.end(), [&](const ObjectPose& pose) {
    return std::any_of(detections.detections.begin(), detections.detections.end(),
                       [&](const Detection& detection) { return detection.class_name == pose.class_name; });
  });
}

}  // namespace

std::vector<std::string> PoseHistory::note_classes(const Detections& detections, std::int64_t arrival_number) {
  constexpr std::size_t kFrames = 16;
  std::set<std::string> names;
  for (const Detection& detection : detections.detections) names.insert(detection.class_name);
  const auto known = std::find_if(classes_.begin(), classes_.end(),
                                  [&](const FrameClasses& classes) { return classes.frame == detections.frame; });
  if (known == classes_.end()) {
    classes_.push_back({detections.frame, arrival_number, std::move(names)});
    if (classes_.size() > kFrames) classes_.pop_front();
    return {};
  }
  if (known->number != arrival_number) {
    detectors_.forget(detections.frame);
    *known = {detections.frame, arrival_number, std::move(names)};
    return {};
  }
  std::vector<std::string> duplicates;
  for (const std::string& name : names) {
    if (!known->names.insert(name).second) duplicates.push_back(name);
  }
  return duplicates;
}

ObjectPoses PoseHistory::find_warm_start(const Detections& detections) const {
  const auto camera = cameras_.find(detections.frame.channel);
  if (camera == cameras_.end()) return {};
  const std::deque<ObjectPoses>& history = camera->second;
  if (detectors_.estimate(detections.frame.channel) == 1) return history.back();
  const auto found = std::find_if(history.rbegin(), history.rend(), [&](const ObjectPoses& poses) {
    return poses.frame.utime < detections.frame.utime && has_common_class(poses, detections);
  });
  return found == history.rend() ? ObjectPoses{} : *found;
}

void PoseHistory::add(const ObjectPoses& poses) {
  constexpr std::size_t kResults = 16;
  std::deque<ObjectPoses>& history = cameras_[poses.frame.channel];
  history.push_back(poses);
  if (history.size() > kResults) history.pop_front();
  detectors_.note_result(poses.frame);
}

}  // namespace houghstream
