#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/wire_reader.hpp"
#include "pipeline/types/frame_id.hpp"

// Checks that lcm-gen's decoders leave out: they trust every count, and a damaged one makes them allocate gigabytes.

namespace houghstream {

/// A frame of 4K (kMaxPixels), uncompressed, has less. Whoever keeps encoded frames can count on it.
inline constexpr std::size_t kMaxFrameBytes = std::size_t{64} << 20U;

/// Stage times of a result, and the bytes that the name of a class, a stage or a process may have: more, or longer
/// ones, are refused.
inline constexpr std::size_t kMaxStages = 256;
inline constexpr std::size_t kMaxNameLength = 255;

/// Time, counter and run of a frame, readable without decoding its images.
struct FrameHeader {
  std::int64_t utime = 0;
  std::optional<std::int64_t> sequence;  ///< the source's frame counter, if the message carries one
  std::int64_t run = 0;                  ///< run of the source, 0 where the message does not say
};

/// Walks through a whole encoded images_t. Throws InputError where its counts and sizes do not add up.
FrameHeader read_frame_header(ByteView bytes);

/// Returns the utime of any encoded message of this project that names a frame by it: it follows the fingerprint.
std::int64_t read_utime(ByteView bytes, const std::string& source);

/// Returns the frame of an encoded detections_t, object_poses_t or objects_t, without decoding or checking the rest.
/// Throws InputError, naming `source`, where the message is of another type or cut.
FrameId read_result_frame(ByteView bytes, const std::string& source);

/// Returns whether the bytes begin with the fingerprint of images_t. Messages that match a channel pattern are checked
/// for nothing else.
bool is_frame_message(ByteView bytes);

/// Parses a frame counter, or a run, as decimal text in the metadata. Throws InputError.
std::int64_t parse_sequence(ByteView text);

/// Throws InputError for the time of a stage that is absurd.
void check_stage_time(std::int64_t duration_us, const std::string& source);

/// Throws InputError unless the bytes are one whole message of the type with this fingerprint, no larger than one of it
/// may be. Types known here:
/// images_t, detections_t, object_poses_t, pose_probabilities_t, camera_colours_t, camera_timing_t, objects_t,
/// placed_objects_t, status_t, known_objects_t, teaching_t, rigid_transform_t.
void check_wire(ByteView bytes, std::int64_t fingerprint, const std::string& type);

/// Decodes one whole message. Throws InputError.
template <typename Message>
Message decode_message(ByteView bytes) {
  check_wire(bytes, Message::getHash(), Message::getTypeName());
  Message message{};
  const int used = message.decode(bytes.data, 0, static_cast<int>(bytes.size));
  require(used == static_cast<int>(bytes.size), "{}: {} of {} bytes decoded", Message::getTypeName(), used, bytes.size);
  return message;
}

template <typename Message>
std::vector<std::uint8_t> encode_message(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  const int used = message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  require(used == static_cast<int>(bytes.size()), "{}: {} of {} bytes encoded", Message::getTypeName(), used,
          bytes.size());
  return bytes;
}

}  // namespace houghstream
