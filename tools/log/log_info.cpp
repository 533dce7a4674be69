#include "tools/log/log_info.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>
#include <houghstream/images_t.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/printable.hpp"
#include "pipeline/bus/sequence_tracker.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "pipeline/types/frame_id.hpp"
#include "tools/log/message_types.hpp"

namespace houghstream::log_tools {
namespace {

std::string describe_frame(ByteView bytes) {
  const auto message = decode_message<images_t>(bytes);
  std::string text;
  for (std::size_t i = 0; i < message.images.size(); ++i) {
    const image_t& image = message.images[i];
    const bool depth = message.image_types[i] == images_t::DEPTH_MM;
    const bool zipped = message.image_types[i] == images_t::DEPTH_MM_ZIPPED;
    const bool jpeg = image.pixelformat == image_t::PIXEL_FORMAT_MJPEG;
    const std::string kind = depth    ? "raw depth"
                             : zipped ? "zipped depth"
                             : jpeg   ? "JPEG"
                                      : fmt::format("image of type {}", message.image_types[i]);
    text +=
        fmt::format("{}{} {}x{}", i == 0 ? "" : ", ",
                    message.image_types[i] == images_t::LEFT && !jpeg ? "raw colour" : kind, image.width, image.height);
  }
  const auto camera = read_camera_metadata(message);
  if (!camera) return text + ", without a camera (give --camera)";
  return text + fmt::format(", camera {}x{},{:g},{:g},{:g},{:g}", camera->width, camera->height, camera->fx, camera->fy,
                            camera->cx, camera->cy);
}

/// Adds events to the information, and keeps what is needed from one to the next.
class Counter {
 public:
  Counter(LogInfo& info, LossReport& losses) : info_(info), losses_(losses) {}

  void add(const LogEvent& event) {
    if (info_.events++ == 0) info_.first = info_.last = event.timestamp;
    info_.last = std::max(info_.last, event.timestamp);
    ChannelInfo& channel = info_.channels[event.channel];
    if (channel.messages++ == 0) channel.first = channel.last = event.timestamp;
    const std::int64_t gap = microseconds_between(channel.last, event.timestamp);
    if (gap > channel.max_gap) {
      channel.max_gap = gap;
      channel.gap_at = event.timestamp;
    }
    channel.last = std::max(channel.last, event.timestamp);
    channel.bytes += event.data.size();
    const ByteView bytes{event.data.data(), event.data.size()};
    channel.types.insert(type_name(fingerprint_of(bytes)));
    if (fingerprint_of(bytes) == images_t::getHash()) add_frame(event.channel, channel, bytes, event.timestamp);
  }

 private:
  void add_frame(const std::string& name, ChannelInfo& channel, ByteView bytes, std::int64_t timestamp) {
    try {
      const FrameHeader header = read_frame_header(bytes);
      if (channel.frames.empty()) channel.frames = describe_frame(bytes);
      SequenceTracker& numbers = numbers_[name];
      numbers.note({header.sequence, header.utime, header.run}, timestamp);
      channel.frames_lost = numbers.lost().value_or(0);
    } catch (const InputError& error) {
      losses_.note_refused(error.what());
    }
  }

  LogInfo& info_;
  LossReport& losses_;
  std::map<std::string, SequenceTracker> numbers_;  // by channel name
};

double seconds(std::int64_t microseconds) {
  return static_cast<double>(microseconds) * 1e-6;
}

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) * 1e-6;
}

std::string date_of(std::int64_t utime) {
  constexpr std::int64_t kYear9999 = 253'402'300'799;  // seconds
  const std::int64_t since_1970 = utime / 1'000'000;
  if (since_1970 < 0 || since_1970 > kYear9999) return fmt::format("no date ({} us)", utime);
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(static_cast<std::time_t>(since_1970)));
}

}  // namespace

double ChannelInfo::rate_hz() const {
  return last > first ? static_cast<double>(messages - 1) / seconds(microseconds_between(first, last)) : 0.0;
}

LogInfo read_log_info(const std::filesystem::path& log_file, LossReport& losses) {
  LogInfo info;
  info.file = log_file.string();
  IntactEvents events(log_file, losses);
  info.file_bytes = std::filesystem::file_size(log_file);
  Counter counter(info, losses);
  while (const std::optional<LogEvent> event = events.next()) counter.add(*event);
  return info;
}

std::string to_text(const LogInfo& info) {
  std::string text =
      fmt::format("{}: {:.1f} MB, {} events in {:.2f} s from {}\n", info.file, megabytes(info.file_bytes), info.events,
                  seconds(microseconds_between(info.first, info.last)), date_of(info.first));
  text += fmt::format("{:<28} {:<30} {:>8} {:>8} {:>9} {:>9}  {}\n", "channel", "type", "messages", "Hz", "MB",
                      "kB each", "longest gap");
  for (const auto& [name, channel] : info.channels) {
    const double mean_kb = static_cast<double>(channel.bytes) / static_cast<double>(channel.messages) * 1e-3;
    text += fmt::format("{:<28} {:<30} {:>8} {:>8.2f} {:>9.2f} {:>9.2f}  ", printable(name),
                        printable(fmt::format("{}", fmt::join(channel.types, ", "))), channel.messages,
                        channel.rate_hz(), megabytes(channel.bytes), mean_kb);
    text += channel.messages < 2 ? "-\n"
                                 : fmt::format("{:.3f} s before {:.3f} s\n", seconds(channel.max_gap),
                                               seconds(microseconds_between(info.first, channel.gap_at)));
  }
  for (const auto& [name, channel] : info.channels) {
    if (channel.frames.empty()) continue;
    text += fmt::format("{}: {}; {} frames missing in their numbering\n", printable(name), channel.frames,
                        channel.frames_lost);
  }
  return text;
}

OrderedJson to_json(const LogInfo& info) {
  OrderedJson channels = OrderedJson::array();
  for (const auto& [name, channel] : info.channels) {
    const bool has_gap = channel.messages > 1;
    OrderedJson entry;
    entry["name"] = printable(name);
    entry["types"] = OrderedJson::array();
    for (const std::string& type : channel.types) entry["types"].push_back(printable(type));
    entry["messages"] = channel.messages;
    entry["bytes"] = channel.bytes;
    entry["first_utime"] = channel.first;
    entry["last_utime"] = channel.last;
    entry["rate_hz"] = channel.last > channel.first ? OrderedJson(channel.rate_hz()) : OrderedJson();
    entry["longest_gap_s"] = has_gap ? OrderedJson(seconds(channel.max_gap)) : OrderedJson();
    entry["longest_gap_until_utime"] = has_gap ? OrderedJson(channel.gap_at) : OrderedJson();
    if (!channel.frames.empty()) {
      entry["frames"] = channel.frames;
      entry["frames_lost"] = channel.frames_lost;
    }
    channels.push_back(std::move(entry));
  }
  OrderedJson json;
  json["file"] = printable(info.file);
  json["bytes"] = info.file_bytes;
  json["events"] = info.events;
  json["first_utime"] = info.first;
  json["last_utime"] = info.last;
  json["duration_s"] = seconds(microseconds_between(info.first, info.last));
  json["channels"] = std::move(channels);
  return json;
}

}  // namespace houghstream::log_tools
