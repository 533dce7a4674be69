#include "pipeline/messages/placed_objects_message.hpp"

#include <algorithm>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_values.hpp"

namespace houghstream {
namespace {

void set_transform(const Eigen::Isometry3d& T, double* trans, double* quat) {
  const rigid_transform_t transform = to_message(0, T);
  std::copy_n(transform.trans, 3, trans);
  std::copy_n(transform.quat, 4, quat);
}

placed_object_t placed_to_message(const ObjectPlacement& object) {
  placed_object_t message{};
  message.track_id = object.track_id;
  message.class_name = object.class_name;
  set_transform(object.T_world_box, message.box_trans, message.box_quat);
  std::copy_n(object.box_size.data(), 3, message.box_size);
  for (const PlacedObjectFrame& frame : object.frames) {
    placed_frame_t& entry = message.frames.emplace_back();
    entry.name = frame.name;
    set_transform(frame.T_world_frame, entry.trans, entry.quat);
  }
  message.n_frames = static_cast<std::int32_t>(message.frames.size());
  return message;
}

ObjectPlacement placed_from_message(const placed_object_t& message) {
  const std::string name = fmt::format("object {} '{}'", message.track_id, message.class_name);
  require(message.track_id > 0, "{}: expected a number above 0", name);
  ObjectPlacement object;
  object.track_id = message.track_id;
  object.class_name = message.class_name;
  object.T_world_box = pose_from_wire(message.box_trans, message.box_quat, name);
  object.box_size = Eigen::Vector3d(message.box_size);
  require(object.box_size.minCoeff() >= 0.0 && object.box_size.maxCoeff() <= kMaxDistanceM,
          "{}: a box of {} x {} x {} m, expected 0 to {:g}", name, message.box_size[0], message.box_size[1],
          message.box_size[2], kMaxDistanceM);
  for (const placed_frame_t& frame : message.frames) {
    PlacedObjectFrame& entry = object.frames.emplace_back();
    entry.name = frame.name;
    entry.T_world_frame = pose_from_wire(frame.trans, frame.quat, name + " frame '" + frame.name + "'");
  }
  return object;
}

}  // namespace

placed_objects_t to_message(const ObjectPlacements& placed) {
  placed_objects_t message{};
  message.utime = placed.frame.utime;
  message.source_channel = placed.frame.channel;
  message.world = placed.world;
  message.world_number = placed.world_number;
  for (const ObjectPlacement& object : placed.objects) message.objects.push_back(placed_to_message(object));
  message.n_objects = static_cast<std::int32_t>(message.objects.size());
  return message;
}

ObjectPlacements placed_objects_from_message(const placed_objects_t& message) {
  try {
    ObjectPlacements placed;
    placed.frame = {message.source_channel, message.utime};
    placed.world = message.world;
    placed.world_number = message.world_number;
    for (const placed_object_t& object : message.objects) placed.objects.push_back(placed_from_message(object));
    return placed;
  } catch (const InputError& error) {
    fail("placed objects after frame {}: {}", to_string(FrameId{message.source_channel, message.utime}), error.what());
  }
}

}  // namespace houghstream
