#include "tools/track/world_reference.hpp"

#include <optional>

#include "pipeline/base/log_line.hpp"
#include "pipeline/messages/channels.hpp"

namespace houghstream::track {

WorldReference::WorldReference(const std::map<std::string, Eigen::Isometry3d>& fixed) {
  for (const auto& [camera, T_world_camera] : fixed)
    extrinsics_.set_static(channel::camera_name(camera), T_world_camera);
}

void WorldReference::add(const std::string& camera, std::int64_t utime, const Eigen::Isometry3d& T_world_camera) {
  const std::lock_guard<std::mutex> lock(mutex_);
  extrinsics_.add_transform(camera, utime, T_world_camera);
}

tracks::CameraPose WorldReference::camera_pose(const FrameId& frame, bool may_wait) {
  const std::lock_guard<std::mutex> lock(mutex_);
  tracks::CameraPose pose = extrinsics_.interpolate(channel::camera_name(frame.channel), frame.utime);
  pose.may_come = pose.may_come && may_wait && (reference_camera_.empty() || extrinsics_.any());
  if (pose.T_world_camera || pose.may_come) return set_world("WORLD", pose);
  if (extrinsics_.any()) return pose;
  if (!reference_camera_.empty() && reference_camera_ != frame.channel)
    return {std::nullopt, false,
            "the pose of its camera is not known, expected --cameras, --camera-pose or " +
                channel::to_world(frame.channel)};
  if (reference_camera_.empty())
    log_info("the pose of {} is not known: the world is its own frame, and objects move when it does", frame.channel);
  reference_camera_ = frame.channel;
  return set_world(frame.channel, {Eigen::Isometry3d::Identity(), false, ""});
}

tracks::CameraPose WorldReference::set_world(const std::string& world, const tracks::CameraPose& pose) {
  if (!pose.T_world_camera || name_ == world) return pose;
  if (!name_.empty()) {
    log_warning("the world is {} from here on, no longer {}: a new one begins", world, name_);
    was_reset_ = true;
  }
  name_ = world;
  return pose;
}

}  // namespace houghstream::track
