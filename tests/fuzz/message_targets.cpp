#include <houghstream/drake_image_array_t.hpp>
#include <houghstream/status_t.hpp>

#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/placed_objects_message.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/tools/log/recordings.hpp"
#include "tools/log/message_types.hpp"
#include "tools/log/third_party_frames.hpp"

namespace houghstream::fuzz {
namespace {

Taken read_frame(ByteView input) {
  read_frame_header(input);
  return {frame_from_message(decode_message<images_t>(input), "LEFT", std::nullopt).colour.total()};
}

std::vector<Bytes> frames() {
  const RgbdFrame frame = make_test_frame(5, 16, 12);
  WireFormat raw;
  raw.jpeg = raw.zip_depth = false;
  images_t message = to_message(frame, {}, 7);
  add_run(message, 99);
  return {encode_message(message), encode_message(to_message(frame, raw, 8))};
}

ObjectPoses posed() {
  ObjectPose pose;
  pose.class_id = 1;
  pose.class_name = "mug";
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.2, 0.7));
  ObjectPoses poses;
  poses.frame = {"LEFT", 5};
  poses.poses = {pose};
  return poses;
}

/// Reads all other messages of this project, by their fingerprint.
Taken read_result(ByteView input) {
  const std::int64_t fingerprint = log_tools::fingerprint_of(input);
  if (fingerprint == detections_t::getHash()) detections_from_message(decode_message<detections_t>(input));
  if (fingerprint == object_poses_t::getHash()) poses_from_message(decode_message<object_poses_t>(input));
  if (fingerprint == pose_probabilities_t::getHash()) {
    ObjectPoses poses = posed();
    apply_probabilities(decode_message<pose_probabilities_t>(input), poses);
  }
  if (fingerprint == camera_timing_t::getHash()) camera_timing_from_message(decode_message<camera_timing_t>(input));
  if (fingerprint == camera_colours_t::getHash()) camera_colours_from_message(decode_message<camera_colours_t>(input));
  if (fingerprint == teaching_t::getHash()) teaching_from_message(decode_message<teaching_t>(input));
  if (fingerprint == status_t::getHash()) decode_message<status_t>(input);
  if (fingerprint == known_objects_t::getHash()) decode_message<known_objects_t>(input);
  if (fingerprint == objects_t::getHash()) world_from_message(decode_message<objects_t>(input));
  if (fingerprint == placed_objects_t::getHash()) placed_objects_from_message(decode_message<placed_objects_t>(input));
  if (fingerprint == rigid_transform_t::getHash()) transform_from_message(decode_message<rigid_transform_t>(input));
  return {};
}

WorldObjects world_of(const FrameId& frame) {
  WorldObjects world;
  world.frame = frame;
  world.world = "WORLD";
  world.world_number = 1;
  TrackedObject object;
  object.track_id = 3;
  object.class_id = 1;
  object.class_name = "mug";
  object.state = TrackState::kVisible;
  object.probability = 0.9F;
  object.last_seen = frame;
  object.reason = "seen by LEFT";
  world.objects = {object};
  world.stages = {{"track.update", 5}};
  return world;
}

std::vector<Bytes> results() {
  Detections detections;
  detections.frame = {"LEFT", 5};
  Detection detection;
  detection.class_id = 1;
  detection.class_name = "mug";
  detection.box_px = {1.0F, 2.0F, 3.0F, 4.0F};
  detection.rotations.push_back({Eigen::Quaternionf::Identity(), 1.0F});
  detections.detections = {detection};
  detections.stages = {{"detect.decode", 12}};
  const ObjectPoses poses = posed();
  Teaching teaching;
  teaching.frame = detections.frame;
  teaching.name = "mug";
  teaching.state = TeachingState::kTracking;
  teaching.directions = {{Eigen::Vector3f::UnitZ(), true}};
  KnownObjects known;
  known.store = "my.store";
  known.objects = {{"mug", 5}};
  status_t status{};
  status.process = "hs-detect";
  ObjectPlacement placed;
  placed.track_id = 3;
  placed.class_name = "mug";
  placed.frames.push_back({"handle", Eigen::Isometry3d::Identity()});
  ObjectPlacements all_placed;
  all_placed.frame = detections.frame;
  all_placed.objects = {placed};
  return {encode_message(to_message(detections)),
          encode_message(to_message(all_placed)),
          encode_message(to_message(poses)),
          encode_message(probabilities_to_message(poses)),
          encode_message(to_message(teaching)),
          encode_message(to_message(known)),
          encode_message(status),
          encode_message(to_message(world_of(detections.frame))),
          encode_message(to_message(7, Eigen::Isometry3d::Identity()))};
}

Taken read_foreign(ByteView input) {
  const bool is_drake = log_tools::fingerprint_of(input) == drake_image_array_t::getHash();
  return {images_from_message(is_drake ? log_tools::images_from_drake(input) : log_tools::images_from_kinect(input))
              .colour.total()};
}

std::vector<Bytes> foreign_frames() {
  const RgbdFrame frame = make_test_frame(5, 16, 12);
  return {encode_message(log_tools::kinect_message(frame, true)),
          encode_message(log_tools::kinect_message(frame, false)), encode_message(log_tools::drake_message(frame))};
}

}  // namespace

std::vector<FuzzTarget> message_targets() {
  constexpr KnownDamage kCuts = {true, {}};
  return {{"frame",
           read_frame,
           frames,
           nullptr,
           {"houghstream.camera", "houghstream.sequence", "houghstream.run"},
           4096,
           kCuts},
          {"result", read_result, results, nullptr, {}},
          {"foreign", read_foreign, foreign_frames, nullptr, {}, 4096, kCuts}};
}

}  // namespace houghstream::fuzz
