#include "tools/track/world_output.hpp"

#include <algorithm>

#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/placed_objects_message.hpp"

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

pose_t frame_pose_message(const TrackedObject& object, const PlacedObjectFrame& frame, std::int64_t utime) {
  TrackedObject at_frame = object;
  at_frame.T_world_object = frame.T_world_frame;
  const Eigen::Vector3d arm = frame.T_world_frame.translation() - object.T_world_object.translation();
  at_frame.velocity.head<3>() += Eigen::Vector3d(object.velocity.tail<3>()).cross(arm);
  return pose_message(at_frame, utime);
}

WorldOutput::WorldOutput(LcmBus& bus, const WorldOutputOptions& options)
    : bus_(bus), pose_channels_(options.pose_channels) {
  if (options.drake_meshes) drake_.emplace(*options.drake_meshes);
}

void WorldOutput::set_models(const tracks::TrackModels& models) {
  has_models_ = !models.empty();
  if (drake_) drake_->set_models(models);
}

void WorldOutput::publish_poses(const WorldObjects& world, const ObjectPlacements& placed) {
  for (const TrackedObject& object : world.objects) {
    if (object.state == TrackState::kGone) continue;
    bus_.publish(channel::object_pose(object.class_name, object.track_id), pose_message(object, world.frame.utime));
    for (const ObjectPlacement& place : placed.objects) {
      if (place.track_id != object.track_id) continue;
      for (const PlacedObjectFrame& frame : place.frames)
        bus_.publish(channel::frame_pose(object.class_name, object.track_id, frame.name),
                     frame_pose_message(object, frame, world.frame.utime));
    }
  }
}

void WorldOutput::publish(const WorldObjects& world, const ObjectPlacements& placed) {
  if (has_models_) bus_.publish(channel::kPlacedObjects, to_message(placed));
  bus_.publish(channel::kObjects, to_message(world));
  if (pose_channels_) publish_poses(world, placed);
  if (!drake_) return;
  const DrakeScene::Messages messages = drake_->messages(world);
  if (messages.load) publish_timeless(bus_, channel::kDrakeLoad, *messages.load, world.frame.utime);
  publish_timeless(bus_, channel::kDrakeDraw, messages.draw, world.frame.utime);
}

}  // namespace houghstream::track
