#pragma once

#include <cstdint>
#include <string>

#include "pipeline/messages/channels.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream::track {

/// Poses of a frame that has a bowl a metre before its camera.
inline ObjectPoses one_bowl(std::int64_t utime, const std::string& camera = channel::kFrame) {
  ObjectPose pose;
  pose.class_id = 1;
  pose.class_name = "bowl";
  pose.status = PoseStatus::kValid;
  pose.quality = 0.95F;
  pose.visible_fraction = 0.9F;
  pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1));
  ObjectPoses poses;
  poses.frame = {camera, utime};
  poses.poses = {pose};
  return poses;
}

/// Makes the message of the frame with this number, at 25 Hz.
inline std::int64_t time_of(int frame) {
  return 1000000000 + 40000 * static_cast<std::int64_t>(frame);
}

}  // namespace houghstream::track
