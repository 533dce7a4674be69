#include "pipeline/process/pose_output.hpp"

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream {

DecodedFrame decode_for_poses(const std::vector<std::uint8_t>& bytes, const std::string& channel,
                              const std::optional<Camera>& camera) {
  StageClock clock;
  RgbdFrame frame = frame_from_message(decode_message<images_t>({bytes.data(), bytes.size()}), channel, camera);
  clock.mark("pose.decode");
  return {std::move(frame), clock.times().front()};
}

void require_max_detections(const Detections& detections) {
  constexpr std::size_t kMax = 512;
  require(detections.detections.size() <= kMax, "frame {}: {} detections, expected at most {}",
          to_string(detections.frame), detections.detections.size(), kMax);
}

TransformPublisher::TransformPublisher(LcmBus& bus, const std::string& frame_channels)
    : bus_(bus), frame_channels_(frame_channels), several_cameras_(!ChannelPattern(frame_channels).is_name()) {}

void TransformPublisher::note_other_camera(const std::string& channel) {
  if (several_cameras_.exchange(true)) return;
  log_info("detections of frames on {} are heard too: transforms go to <OBJECT>_TO_{}", channel,
           channel::camera_name(frame_channels_));
}

void TransformPublisher::publish(const ObjectPoses& poses) {
  const std::string camera = several_cameras_ ? poses.frame.channel : "";
  for (const ObjectPose& pose : poses.poses) {
    if (!pose.T_camera_object) continue;
    bus_.publish(channel::to_camera(pose.class_name, camera), to_message(poses.frame.utime, *pose.T_camera_object));
  }
}

}  // namespace houghstream
