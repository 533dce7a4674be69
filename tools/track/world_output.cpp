#include "tools/track/world_output.hpp"

#include <algorithm>

#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream::track {
namespace {

/// The type has no utime.
template <typename Message>
void publish_timeless(LcmBus& bus, const std::string& channel, const Message& message, std::int64_t utime) {
  const std::vector<std::uint8_t> bytes = encode_message(message);
  bus.publish(channel, {bytes.data(), bytes.size()}, utime);
}

}  // namespace

pose_t pose_message(const TrackedObject& object, std::int64_t utime) {
  const rigid_transform_t transform = to_message(utime, object.T_world_object);
  pose_t message{};
  message.utime = utime;
  std::copy_n(transform.trans, 3, message.pos);
  std::copy_n(transform.quat, 4, message.orientation);
  std::copy_n(object.velocity.data(), 3, message.vel);
  std::copy_n(object.velocity.data() + 3, 3, message.rotation_rate);
  return message;
}

WorldOutput::WorldOutput(LcmBus& bus, const WorldOutputOptions& options)
    : bus_(bus), pose_channels_(options.pose_channels) {
  if (options.drake_meshes) drake_.emplace(*options.drake_meshes);
}

void WorldOutput::set_models(const tracks::TrackModels& models) {
  if (drake_) drake_->set_models(models);
}

void WorldOutput::publish(const WorldObjects& world) {
  bus_.publish(channel::kObjects, to_message(world));
  if (pose_channels_) {
    for (const TrackedObject& object : world.objects) {
      if (object.state == TrackState::kGone) continue;
      bus_.publish(channel::object_pose(object.class_name, object.track_id), pose_message(object, world.frame.utime));
    }
  }
  if (!drake_) return;
  const DrakeScene::Messages messages = drake_->messages(world);
  if (messages.load) publish_timeless(bus_, channel::kDrakeLoad, *messages.load, world.frame.utime);
  publish_timeless(bus_, channel::kDrakeDraw, messages.draw, world.frame.utime);
}

}  // namespace houghstream::track
