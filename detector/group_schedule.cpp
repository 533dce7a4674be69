#include "detector/group_schedule.hpp"

#include <algorithm>
#include <numeric>

#include "detector/forest/forest.hpp"
#include "pipeline/base/check_settings.hpp"
#include "pipeline/types/frame_time.hpp"

namespace houghstream {
namespace {

constexpr double kSlack_s = 0.002;  // for the jitter of times

}  // namespace

GroupSchedule::GroupSchedule(const std::vector<Forest>& groups, const GroupScheduleSettings& settings)
    : settings_(settings), group_count_(groups.size()) {
  check_settings(settings, "schedule of groups");
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const ObjectClass& object : groups[i].classes) group_of_class_[object.name] = i;
  }
}

std::vector<std::size_t> GroupSchedule::select(const FrameId& frame) {
  std::vector<std::size_t> selected;
  if (cameras_.size() >= kCameras && cameras_.count(frame.channel) == 0) {
    selected.resize(group_count_);
    std::iota(selected.begin(), selected.end(), 0);
    return selected;
  }
  Camera& camera = cameras_[frame.channel];
  double passed_s = seconds_between(camera.utime, frame.utime);
  if (camera.turns.empty() || passed_s < -kMaxOvertakenS) {
    camera = Camera{};
    camera.utime = frame.utime;
    camera.turns.resize(group_count_);
    passed_s = 0.0;
  }
  camera.utime = std::max(camera.utime, frame.utime);
  ++camera.frames;
  std::vector<std::size_t> inactive;
  for (std::size_t i = 0; i < group_count_; ++i)
    (is_recent(camera.turns[i].found_utime, camera.utime) ? selected : inactive).push_back(i);
  std::stable_sort(inactive.begin(), inactive.end(), [&](std::size_t a, std::size_t b) {
    return camera.turns[a].searched_frame < camera.turns[b].searched_frame;
  });
  const auto waiting = static_cast<double>(inactive.size());
  camera.waited_s += waiting * std::max(passed_s, 0.0);
  camera.waited_s = std::min(camera.waited_s, waiting * settings_.interval_s);  // a pause counts for one search of each
  for (const std::size_t i : inactive) {
    const bool is_due = camera.waited_s + kSlack_s >= settings_.interval_s || is_overdue(camera.turns[i], camera.utime);
    if (!is_due && !selected.empty()) continue;
    selected.push_back(i);
    camera.waited_s = std::max(0.0, camera.waited_s - settings_.interval_s);
  }
  std::sort(selected.begin(), selected.end());
  for (const std::size_t i : selected) {
    camera.turns[i].searched_frame = camera.frames;
    camera.turns[i].searched_utime = camera.utime;
  }
  return selected;
}

void GroupSchedule::note(const Detections& detections) {
  const auto camera = cameras_.find(detections.frame.channel);
  if (camera == cameras_.end() || is_recent(camera->second.posed_utime, camera->second.utime)) return;
  for (const Detection& detection : detections.detections) {
    if (detection.reported) activate(detection.class_name, camera->second);
  }
}

void GroupSchedule::note(const ObjectPoses& poses) {
  const auto camera = cameras_.find(poses.frame.channel);
  if (camera == cameras_.end()) return;
  for (const ObjectPose& pose : poses.poses) {
    if (pose.status == PoseStatus::kNoModel) continue;
    camera->second.posed_utime = camera->second.utime;
    if (has_pose(pose.status)) activate(pose.class_name, camera->second);
  }
}

bool GroupSchedule::is_recent(const std::optional<std::int64_t>& then, std::int64_t utime) const {
  return then && seconds_between(*then, utime) <= settings_.active_s;
}

void GroupSchedule::activate(const std::string& class_name, Camera& camera) const {
  if (const auto group = group_of_class_.find(class_name); group != group_of_class_.end())
    camera.turns[group->second].found_utime = camera.utime;
}

bool GroupSchedule::is_overdue(const Turn& turn, std::int64_t utime) const {
  return turn.searched_frame == 0 || seconds_between(turn.searched_utime, utime) + kSlack_s >= settings_.interval_s;
}

}  // namespace houghstream
