#include <algorithm>
#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_values.hpp"

namespace houghstream {
namespace {

void set_pose(const Eigen::Isometry3d& T, double* trans, double* quat) {
  const rigid_transform_t transform = to_message(0, T);
  std::copy_n(transform.trans, 3, trans);
  std::copy_n(transform.quat, 4, quat);
}

tracked_object_t object_to_message(const TrackedObject& object) {
  tracked_object_t message{};
  message.track_id = object.track_id;
  message.class_id = object.class_id;
  message.class_name = object.class_name;
  message.state = static_cast<std::int8_t>(object.state);
  message.probability = object.probability;
  message.moving = object.moving ? 1 : 0;
  set_pose(object.T_world_object, message.trans, message.quat);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) message.covariance[row][column] = object.covariance(row, column);
  }
  std::copy_n(object.velocity.data(), 3, message.velocity);
  std::copy_n(object.velocity.data() + 3, 3, message.angular_velocity);
  message.n_seen = object.seen;
  message.first_utime = object.first_utime;
  message.seen_utime = object.last_seen.utime;
  message.seen_channel = object.last_seen.channel;
  message.reason = object.reason;
  return message;
}

TrackedObject object_from_message(const tracked_object_t& message) {
  const std::string name = fmt::format("object {} '{}'", message.track_id, message.class_name);
  require(message.track_id > 0, "{}: expected a number above 0", name);
  require(message.state > tracked_object_t::INVALID && message.state <= tracked_object_t::GONE,
          "{}: state {}, expected {} to {}", name, message.state, tracked_object_t::VISIBLE, tracked_object_t::GONE);
  require(message.probability >= 0.0F && message.probability <= 1.0F, "{}: probability {}, expected 0 to 1", name,
          message.probability);
  TrackedObject out;
  out.track_id = message.track_id;
  out.class_id = message.class_id;
  out.class_name = message.class_name;
  out.state = static_cast<TrackState>(message.state);
  out.probability = message.probability;
  out.moving = message.moving != 0;
  out.T_world_object = pose_from_wire(message.trans, message.quat, name);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) out.covariance(row, column) = message.covariance[row][column];
  }
  out.velocity << Eigen::Vector3d(message.velocity), Eigen::Vector3d(message.angular_velocity);
  require(out.covariance.allFinite() && out.velocity.allFinite(), "{}: covariance or velocity is not finite", name);
  out.seen = message.n_seen;
  out.first_utime = message.first_utime;
  out.last_seen = {message.seen_channel, message.seen_utime};
  out.reason = message.reason;
  return out;
}

}  // namespace

objects_t to_message(const WorldObjects& objects) {
  objects_t message{};
  message.utime = objects.frame.utime;
  message.source_channel = objects.frame.channel;
  message.world = objects.world;
  message.world_number = objects.world_number;
  set_pose(objects.T_world_camera, message.camera_trans, message.camera_quat);
  for (const TrackedObject& object : objects.objects) message.objects.push_back(object_to_message(object));
  message.n_objects = static_cast<std::int32_t>(message.objects.size());
  for (const StageTime& stage : objects.stages) {
    message.stages.emplace_back();
    message.stages.back().stage = stage.stage;
    message.stages.back().duration_us = stage.duration_us;
  }
  message.n_stages = static_cast<std::int32_t>(message.stages.size());
  return message;
}

WorldObjects world_from_message(const objects_t& message) {
  try {
    WorldObjects out;
    out.frame = {message.source_channel, message.utime};
    out.world = message.world;
    out.world_number = message.world_number;
    out.T_world_camera = pose_from_wire(message.camera_trans, message.camera_quat, "camera");
    for (const tracked_object_t& object : message.objects) out.objects.push_back(object_from_message(object));
    for (const stage_time_t& stage : message.stages) out.stages.push_back({stage.stage, stage.duration_us});
    return out;
  } catch (const InputError& error) {
    fail("objects after frame {}: {}", to_string(FrameId{message.source_channel, message.utime}), error.what());
  }
}

Eigen::Isometry3d transform_from_message(const rigid_transform_t& message) {
  return pose_from_wire(message.trans, message.quat, "transform");
}

}  // namespace houghstream
