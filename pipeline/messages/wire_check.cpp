#include "pipeline/messages/wire_check.hpp"

#include <charconv>
#include <houghstream/camera_colours_t.hpp>
#include <houghstream/camera_timing_t.hpp>
#include <houghstream/detections_t.hpp>
#include <houghstream/images_t.hpp>
#include <houghstream/known_objects_t.hpp>
#include <houghstream/object_poses_t.hpp>
#include <houghstream/objects_t.hpp>
#include <houghstream/placed_objects_t.hpp>
#include <houghstream/pose_probabilities_t.hpp>
#include <houghstream/rigid_transform_t.hpp>
#include <houghstream/status_t.hpp>
#include <houghstream/teaching_t.hpp>

#include "pipeline/messages/channels.hpp"

namespace houghstream {
namespace {

/// Returns the maximum length of a message type. A frame of kMaxPixels has less, uncompressed and with rows filled up;
/// LCM itself refuses messages of more than 1 << 28 bytes.
std::size_t max_bytes(std::int64_t fingerprint) {
  if (fingerprint == images_t::getHash()) return kMaxFrameBytes;
  if (fingerprint == status_t::getHash()) return std::size_t{1} << 16U;
  if (fingerprint == known_objects_t::getHash() || fingerprint == teaching_t::getHash()) return std::size_t{1} << 20U;
  if (fingerprint == objects_t::getHash() || fingerprint == placed_objects_t::getHash()) return std::size_t{1} << 22U;
  return std::size_t{1} << 28U;
}

// Fewest bytes that an entry of a list can take on the wire: its numbers, and 5 bytes for an empty string.
constexpr std::size_t kMinMetadata = 5 + 4;
constexpr std::size_t kMinImage = 8 + 5 * 4 + 4;
constexpr std::size_t kMinStage = 5 + 8;
constexpr std::size_t kVote = 4 * 4 + 4;
constexpr std::size_t kDetectionNumbers = 4 + 1 + 4 * 4 + 3 * 4 + 4 + 4;  // score to n_votes_total
constexpr std::size_t kPoseNumbers = 4 + 4 + 1 + 3 * 8 + 4 * 8 + 1 + 4 + 4 + 5 * 4;
constexpr std::size_t kTrackNumbers = 1 + 4 + 1 + (3 + 4 + 36 + 3 + 3) * 8 + 4 + 8 + 8;  // state to seen_utime
constexpr std::size_t kTransform = (3 + 4) * 8;
constexpr std::size_t kStatusNumbers = 4 + 4 + 5 * 8 + 3 * 4;
constexpr std::size_t kKnownObject = 5 + 8;
constexpr std::size_t kTeachingNumbers = 4 + 4 + 4 + 4 * 4 + 3 * 8 + 4 * 8;  // progress to quat
constexpr std::size_t kSeenDirection = 3 * 4 + 1;

/// Texts that are stored, published and printed have a length limit below that of a message.
std::string read_within(WireReader& reader, std::size_t maximum, const char* what) {
  std::string text = reader.read_string();
  require(text.size() <= maximum, "{}: {} of {} bytes, expected at most {}", reader.source(), what, text.size(),
          maximum);
  return text;
}

std::string read_channel(WireReader& reader) {
  return read_within(reader, channel::kMaxBytes, "a channel");
}

void walk_name(WireReader& reader) {
  read_within(reader, kMaxNameLength, "a name");
}

void walk_image(WireReader& reader, FrameHeader& header) {
  reader.skip(8 + 4 * 4);  // utime, width, height, row_stride, pixelformat
  reader.skip(reader.read_count(1));
  for (std::size_t left = reader.read_count(kMinMetadata); left > 0; --left) {
    const std::string key = reader.read_string();
    const ByteView value = reader.read_bytes(reader.read_count(1));
    if (key == metadata::kSequence) header.sequence = parse_sequence(value);
    if (key == metadata::kRun) header.run = parse_sequence(value);
  }
}

FrameHeader walk_images(WireReader& reader) {
  FrameHeader header;
  header.utime = reader.read_int64();
  const std::size_t images = reader.read_count(2 + kMinImage);
  reader.skip(2 * images);
  for (std::size_t i = 0; i < images; ++i) walk_image(reader, header);
  return header;
}

void walk_stages(WireReader& reader) {
  const std::size_t stages = reader.read_count(kMinStage);
  require(stages <= kMaxStages, "{}: {} stages, expected at most {}", reader.source(), stages, kMaxStages);
  for (std::size_t left = stages; left > 0; --left) {
    walk_name(reader);
    check_stage_time(reader.read_int64(), reader.source());
  }
}

void walk_detections(WireReader& reader) {
  reader.skip(8);
  read_channel(reader);
  for (std::size_t left = reader.read_count(4 + 5 + kDetectionNumbers + 4); left > 0; --left) {
    reader.skip(4);
    walk_name(reader);
    reader.skip(kDetectionNumbers);
    reader.skip(kVote * reader.read_count(kVote));
  }
  walk_stages(reader);
}

void walk_poses(WireReader& reader) {
  reader.skip(8);
  read_channel(reader);
  for (std::size_t left = reader.read_count(4 + 5 + kPoseNumbers); left > 0; --left) {
    reader.skip(4);
    walk_name(reader);
    reader.skip(kPoseNumbers);
  }
  walk_stages(reader);
}

void walk_objects(WireReader& reader) {
  reader.skip(8);
  read_channel(reader);
  read_channel(reader);  // the world, which may have a camera's name
  reader.skip(4 + 3 * 8 + 4 * 8);
  for (std::size_t left = reader.read_count(8 + 4 + 5 + kTrackNumbers + 5 + 5); left > 0; --left) {
    reader.skip(8 + 4);
    walk_name(reader);
    reader.skip(kTrackNumbers);
    read_channel(reader);
    reader.read_string();
  }
  walk_stages(reader);
}

void walk_placed_objects(WireReader& reader) {
  reader.skip(8);
  read_channel(reader);
  read_channel(reader);  // the world
  reader.skip(4);
  for (std::size_t objects = reader.read_count(8 + 5 + kTransform + 3 * 8 + 4); objects > 0; --objects) {
    reader.skip(8);
    walk_name(reader);
    reader.skip(kTransform + 3 * 8);
    for (std::size_t frames = reader.read_count(5 + kTransform); frames > 0; --frames) {
      walk_name(reader);
      reader.skip(kTransform);
    }
  }
}

void walk_status(WireReader& reader) {
  reader.skip(8);
  walk_name(reader);
  reader.skip(kStatusNumbers);
  reader.read_string();
}

void walk_probabilities(WireReader& reader) {
  constexpr std::size_t kProbabilities = 4 + 4;
  reader.skip(8);
  read_channel(reader);
  reader.skip(kProbabilities * reader.read_count(kProbabilities));
}

void walk_camera_colours(WireReader& reader) {
  constexpr std::size_t kMinName = 5;
  constexpr std::size_t kNumbers = 6 * 4;
  constexpr std::size_t kMap = (4 + 2 + 1) * 4;
  reader.skip(8);
  read_channel(reader);
  const std::size_t objects = reader.read_count(kMinName + kNumbers);
  for (std::size_t left = objects; left > 0; --left) walk_name(reader);
  reader.skip(kNumbers * objects + kMap);
}

void walk_camera_timing(WireReader& reader) {
  reader.skip(8);
  read_channel(reader);
  reader.skip(4 + 4);
}

void walk_known_objects(WireReader& reader) {
  reader.skip(8);
  walk_name(reader);
  reader.skip(4);
  reader.read_string();
  reader.skip(8);
  const std::size_t objects = reader.read_count(kKnownObject);
  for (std::size_t left = objects; left > 0; --left) walk_name(reader);
  reader.skip(8 * objects);
  reader.read_string();
}

void walk_teaching(WireReader& reader) {
  reader.skip(8);
  read_channel(reader);
  walk_name(reader);
  reader.skip(1);
  reader.read_string();
  reader.skip(kTeachingNumbers);
  reader.skip(kSeenDirection * reader.read_count(kSeenDirection));
}

WireReader open_message(ByteView bytes, std::int64_t fingerprint, const std::string& type) {
  const std::size_t maximum = max_bytes(fingerprint);
  require(bytes.size <= maximum, "{}: {} bytes, expected at most {}", type, bytes.size, maximum);
  WireReader reader(bytes, type);
  const std::int64_t found = reader.read_int64();
  require(found == fingerprint, "message of fingerprint {:016x}, expected {} ({:016x})",
          static_cast<std::uint64_t>(found), type, static_cast<std::uint64_t>(fingerprint));
  return reader;
}

void require_end(const WireReader& reader) {
  require(reader.left() == 0, "{}: {} bytes after its end", reader.source(), reader.left());
}

}  // namespace

FrameHeader read_frame_header(ByteView bytes) {
  WireReader reader = open_message(bytes, images_t::getHash(), images_t::getTypeName());
  const FrameHeader header = walk_images(reader);
  require_end(reader);
  return header;
}

std::int64_t read_utime(ByteView bytes, const std::string& source) {
  WireReader reader(bytes, source);
  reader.skip(8);
  return reader.read_int64();
}

FrameId read_result_frame(ByteView bytes, const std::string& source) {
  WireReader reader(bytes, source);
  const std::int64_t fingerprint = reader.read_int64();
  require(fingerprint == detections_t::getHash() || fingerprint == object_poses_t::getHash() ||
              fingerprint == objects_t::getHash(),
          "{}: message of fingerprint {:016x}, expected detections_t, object_poses_t or objects_t", source,
          static_cast<std::uint64_t>(fingerprint));
  FrameId frame;
  frame.utime = reader.read_int64();
  frame.channel = read_channel(reader);
  return frame;
}

bool is_frame_message(ByteView bytes) {
  return bytes.size >= 8 && WireReader(bytes, images_t::getTypeName()).read_int64() == images_t::getHash();
}

std::int64_t parse_sequence(ByteView text) {
  const std::string shown(reinterpret_cast<const char*>(text.data), std::min<std::size_t>(text.size, 24));
  std::int64_t sequence = -1;
  const char* end = shown.data() + shown.size();
  const auto [stop, error] = std::from_chars(shown.data(), end, sequence);
  require(error == std::errc() && stop == end && sequence >= 0 && text.size == shown.size(),
          "images_t: frame counter '{}', expected a decimal number from 0", shown);
  return sequence;
}

void check_stage_time(std::int64_t duration_us, const std::string& source) {
  constexpr std::int64_t kMaxDurationUs = 1'000'000'000'000;  // eleven days: times are added up
  require(duration_us >= -kMaxDurationUs && duration_us <= kMaxDurationUs,
          "{}: a stage of {} us, expected less than {}", source, duration_us, kMaxDurationUs);
}

void check_wire(ByteView bytes, std::int64_t fingerprint, const std::string& type) {
  WireReader reader = open_message(bytes, fingerprint, type);
  if (fingerprint == images_t::getHash()) {
    walk_images(reader);
  } else if (fingerprint == detections_t::getHash()) {
    walk_detections(reader);
  } else if (fingerprint == object_poses_t::getHash()) {
    walk_poses(reader);
  } else if (fingerprint == pose_probabilities_t::getHash()) {
    walk_probabilities(reader);
  } else if (fingerprint == camera_colours_t::getHash()) {
    walk_camera_colours(reader);
  } else if (fingerprint == camera_timing_t::getHash()) {
    walk_camera_timing(reader);
  } else if (fingerprint == objects_t::getHash()) {
    walk_objects(reader);
  } else if (fingerprint == placed_objects_t::getHash()) {
    walk_placed_objects(reader);
  } else if (fingerprint == status_t::getHash()) {
    walk_status(reader);
  } else if (fingerprint == known_objects_t::getHash()) {
    walk_known_objects(reader);
  } else if (fingerprint == teaching_t::getHash()) {
    walk_teaching(reader);
  } else if (fingerprint == rigid_transform_t::getHash()) {
    reader.skip(8 + 3 * 8 + 4 * 8);
  } else {
    throw std::logic_error("check_wire does not know " + type);
  }
  require_end(reader);
}

}  // namespace houghstream
