#include "tools/log/export_mcap.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/files.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/placed_objects_message.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "pipeline/types/reported_objects.hpp"
#include "tools/foxglove/foxglove_messages.hpp"
#include "tools/foxglove/mcap_writer.hpp"
#include "tools/foxglove/protobuf_message.hpp"
#include "tools/log/message_types.hpp"
#include "tools/log/third_party_frames.hpp"

namespace houghstream::log_tools {
namespace {

/// The results of each frame, by the number of the log's event that completes them.
using ResultsByEvent = std::map<std::int64_t, FrameResults>;

/// All results of a frame, and the last event of the log that adds one.
struct CollectedResults {
  FrameResults results;
  std::int64_t last_event = 0;
};

/// Adds a message to the results of its frame; a message that is no result is passed over.
void add_result(const LogEvent& event, std::int64_t number, std::map<FrameId, CollectedResults>& found) {
  const ByteView bytes{event.data.data(), event.data.size()};
  const auto add = [&](auto result) {
    CollectedResults& of_frame = found[result.frame];
    of_frame.results.add(std::move(result));
    of_frame.last_event = number;
  };
  if (event.channel == channel::kDetections) add(detections_from_message(decode_message<detections_t>(bytes)));
  if (event.channel == channel::kPoses) add(poses_from_message(decode_message<object_poses_t>(bytes)));
}

/// Reads all results ahead: whether a candidate counts, its pose tells, which comes later. What cannot be understood is
/// counted in `losses`, damage of the log is not, which is met again when it is read for the rest.
ResultsByEvent collect_results(const std::filesystem::path& log_file, LossReport& losses) {
  LossReport damage;
  IntactEvents events(log_file, damage);
  std::map<FrameId, CollectedResults> found;
  std::int64_t number = 0;
  for (std::optional<LogEvent> event = events.next(); event; event = events.next(), ++number) {
    try {
      add_result(*event, number, found);
    } catch (const InputError& error) {
      losses.note_refused(error.what());
    }
  }
  ResultsByEvent results;
  for (auto& [frame, collected] : found) {
    for (std::size_t i = 0; i < collected.results.unmatched().size(); ++i)
      losses.note_refused(fmt::format("poses of frame {}, of no detections in the log", to_string(frame)));
    results[collected.last_event] = std::move(collected.results);
  }
  return results;
}

/// Writes messages of Foxglove to a file, which is made with the first one.
class MessageFile {
 public:
  explicit MessageFile(std::filesystem::path file) : file_(std::move(file)) {}

  void write(const std::vector<foxglove::FoxgloveMessage>& messages, std::int64_t event_us) {
    for (const foxglove::FoxgloveMessage& message : messages) {
      if (!writer_) writer_.emplace(file_);
      writer_->write(channel_of(message), {nanoseconds(event_us), nanoseconds(message.utime)}, message.data);
    }
  }

  /// Returns false where nothing was written.
  bool close() {
    if (writer_) writer_->close();
    return writer_.has_value();
  }

 private:
  static std::uint64_t nanoseconds(std::int64_t utime) { return static_cast<std::uint64_t>(utime) * 1000; }

  std::uint16_t channel_of(const foxglove::FoxgloveMessage& message) {
    const auto known = channels_.find(message.topic);
    if (known != channels_.end()) return known->second;
    foxglove::McapChannel channel;
    channel.topic = message.topic;
    channel.message_encoding = channel.schema_encoding = "protobuf";
    channel.schema_name = message.type;
    channel.schema = foxglove::encode_descriptor(message.type);
    return channels_[message.topic] = writer_->add_channel(channel);
  }

  std::filesystem::path file_;
  std::optional<foxglove::McapWriter> writer_;
  std::map<std::string, std::uint16_t> channels_;
};

/// Throws InputError for a time that MCAP cannot hold: its times are nanoseconds since the epoch in 64 bits.
void require_time(std::int64_t utime) {
  constexpr std::int64_t kMaxUtime = 9'000'000'000'000'000;  // the year 2255
  require(utime >= 0 && utime <= kMaxUtime, "time of {} us, expected 0 to {}", utime, kMaxUtime);
}

/// Converts the events of a log one after another.
class LogConversion {
 public:
  LogConversion(const McapExtras& extras, ResultsByEvent results)
      : messages_(extras.models), camera_(extras.camera), results_(std::move(results)) {}

  /// Throws InputError where the event cannot be understood.
  std::vector<foxglove::FoxgloveMessage> convert(const LogEvent& event, std::int64_t number) {
    require_time(event.timestamp);
    const ByteView bytes{event.data.data(), event.data.size()};
    if (is_frame_type(fingerprint_of(bytes))) return convert_frame(event, bytes);
    const auto results = results_.find(number);
    if (results != results_.end()) return convert_results(results->second);
    if (event.channel == channel::kPlacedObjects) {
      placed_ = placed_objects_from_message(decode_message<placed_objects_t>(bytes));
    } else if (event.channel == channel::kObjects) {
      const WorldObjects world = world_from_message(decode_message<objects_t>(bytes));
      require_time(world.frame.utime);
      return messages_.convert_world(world, placed_);
    } else if (fingerprint_of(bytes) == rigid_transform_t::getHash()) {
      const auto message = decode_message<rigid_transform_t>(bytes);
      require_time(message.utime);
      return messages_.convert_camera_pose(event.channel, message.utime, transform_from_message(message));
    }
    return {};
  }

  std::int64_t frames() const { return frames_; }

 private:
  std::vector<foxglove::FoxgloveMessage> convert_frame(const LogEvent& event, ByteView bytes) {
    const images_t frame = to_images(bytes);
    require_time(frame.utime);
    std::vector<foxglove::FoxgloveMessage> messages = messages_.convert_frame(frame, event.channel, camera_);
    ++frames_;
    return messages;
  }

  std::vector<foxglove::FoxgloveMessage> convert_results(const FrameResults& results) {
    const std::optional<ReportedObjects> objects = report_objects(results);
    if (!objects) return {};
    require_time(objects->frame.utime);
    return messages_.convert_objects(*objects);
  }

  foxglove::FoxgloveMessages messages_;
  std::optional<Camera> camera_;
  ResultsByEvent results_;
  std::optional<ObjectPlacements> placed_;
  std::int64_t frames_ = 0;
};

}  // namespace

std::int64_t export_mcap(const std::filesystem::path& log_file, const McapExtras& extras,
                         const std::filesystem::path& out_file, LossReport& losses) {
  require_other_file(out_file, log_file);
  LogConversion conversion(extras, collect_results(log_file, losses));
  MessageFile out(out_file);
  IntactEvents events(log_file, losses);
  std::int64_t number = 0;
  for (std::optional<LogEvent> event = events.next(); event; event = events.next(), ++number) {
    std::vector<foxglove::FoxgloveMessage> messages;
    try {
      messages = conversion.convert(*event, number);
    } catch (const InputError& error) {
      losses.note_refused(error.what());
      continue;
    }
    out.write(messages, event->timestamp);
  }
  require(
      out.close(),
      "{}: no frame, detection or object that could be exported; hs-pose --keep-frames keeps these beside its poses{}",
      log_file.string(), losses.line().empty() ? "" : ": " + losses.line());
  if (conversion.frames() == 0) {
    losses.add_warning(
        "no frames in it, so there are no images; hs-log record takes them off the bus, --keep-frames of hs-detect "
        "and hs-pose keeps them beside the results of a log");
  }
  return conversion.frames();
}

}  // namespace houghstream::log_tools
