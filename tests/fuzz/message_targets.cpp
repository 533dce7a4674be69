#include <houghstream/drake_image_array_t.hpp>
#include <houghstream/status_t.hpp>

#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "pipeline/types/camera.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/tools/log/recordings.hpp"
#include "tools/log/foreign_frames.hpp"
#include "tools/log/message_types.hpp"

namespace houghstream::fuzz {
namespace {

void read_frame(ByteView input) {
  read_frame_header(input);
  frame_from_message(decode_message<images_t>(input), "LEFT", std::nullopt);
}

std::vector<Bytes> frames() {
  const RgbdFrame frame = make_test_frame(5, 16, 12);
  WireFormat raw;
  raw.jpeg = raw.zip_depth = false;
  images_t message = to_message(frame, {}, 7);
  add_run(message, 99);
  return {encode_message(message), encode_message(to_message(frame, raw, 8))};
}

/// Every other message of ours, by its fingerprint.
void read_result(ByteView input) {
  const std::int64_t fingerprint = log_tools::fingerprint_of(input);
  if (fingerprint == detections_t::getHash()) detections_from_message(decode_message<detections_t>(input));
  if (fingerprint == object_poses_t::getHash()) poses_from_message(decode_message<object_poses_t>(input));
  if (fingerprint == teaching_t::getHash()) teaching_from_message(decode_message<teaching_t>(input));
  if (fingerprint == status_t::getHash()) decode_message<status_t>(input);
  if (fingerprint == known_objects_t::getHash()) decode_message<known_objects_t>(input);
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
  ObjectPoses poses;
  poses.frame = detections.frame;
  ObjectPose pose;
  pose.class_id = 1;
  pose.class_name = "mug";
  pose.status = PoseStatus::kValid;
  pose.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.2, 0.7));
  poses.poses = {pose};
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
  return {encode_message(to_message(detections)), encode_message(to_message(poses)),
          encode_message(to_message(teaching)), encode_message(to_message(known)), encode_message(status)};
}

void read_foreign(ByteView input) {
  const bool is_drake = log_tools::fingerprint_of(input) == drake_image_array_t::getHash();
  images_from_message(is_drake ? log_tools::images_from_drake(input) : log_tools::images_from_kinect(input));
}

std::vector<Bytes> foreign_frames() {
  const RgbdFrame frame = make_test_frame(5, 16, 12);
  return {encode_message(log_tools::kinect_message(frame, true)),
          encode_message(log_tools::kinect_message(frame, false)), encode_message(log_tools::drake_message(frame))};
}

/// What people and messages name in words: a first letter says which reader takes the rest.
void read_words(ByteView input) {
  if (input.size == 0) return;
  const std::string text(reinterpret_cast<const char*>(input.data) + 1, input.size - 1);
  if (input.data[0] == 'p') ChannelPattern(text).matches("OPENNI_FRAME");
  if (input.data[0] == 'c') parse_camera(text);
  if (input.data[0] == 's') parse_sequence({input.data + 1, input.size - 1});
}

std::vector<Bytes> words() {
  return {bytes_of_text("pOPENNI_.*|LEFT"), bytes_of_text("c640x480,525,525,319.5,239.5"), bytes_of_text("s12345")};
}

}  // namespace

std::vector<FuzzTarget> message_targets() {
  return {{"frame", read_frame, frames, nullptr, {"houghstream.camera", "houghstream.sequence", "houghstream.run"}},
          {"result", read_result, results, nullptr, {}},
          {"foreign", read_foreign, foreign_frames, nullptr, {}},
          {"words", read_words, words, nullptr, {"[a-z]", "(a|b)*", "{2,3}", "\\d", "640x480,", "1e308"}, 128}};
}

}  // namespace houghstream::fuzz
