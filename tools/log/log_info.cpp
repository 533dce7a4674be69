#include "tools/log/log_info.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ctime>
#include <houghstream/images_t.hpp>

#include "pipeline/base/checks.hpp"
#include "pipeline/messages/messages.hpp"
#include "pipeline/messages/wire_check.hpp"
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
  const auto camera = camera_of(message);
  if (!camera) return text + ", without a camera (give --camera)";
  return text + fmt::format(", camera {}x{},{:g},{:g},{:g},{:g}", camera->width, camera->height, camera->fx, camera->fy,
                            camera->cx, camera->cy);
}

/// Adds events to the information, and keeps what is needed from one to the next.
class Counter {
 public:
  Counter(LogInfo& info, LossAccount& losses) : info_(info), losses_(losses) {}

  void add(const LogEvent& event) {
    if (info_.events++ == 0) info_.first = info_.last = event.timestamp;
    info_.last = std::max(info_.last, event.timestamp);
    ChannelInfo& channel = info_.channels[event.channel];
    if (channel.messages++ == 0) channel.first = channel.last = event.timestamp;
    if (event.timestamp - channel.last > channel.longest_gap) {
      channel.longest_gap = event.timestamp - channel.last;
      channel.gap_at = event.timestamp;
    }
    channel.last = std::max(channel.last, event.timestamp);
    channel.bytes += event.data.size();
    const ByteView bytes{event.data.data(), event.data.size()};
    channel.types.insert(type_name(fingerprint_of(bytes)));
    if (fingerprint_of(bytes) == images_t::getHash()) add_frame(event.channel, channel, bytes);
  }

 private:
  void add_frame(const std::string& name, ChannelInfo& channel, ByteView bytes) {
    try {
      const FrameHeader header = read_frame_header(bytes);
      if (channel.frames.empty()) channel.frames = describe_frame(bytes);
      const auto before = last_sequences_.find(name);
      if (header.sequence && before != last_sequences_.end() && *header.sequence > before->second) {
        channel.frames_lost += *header.sequence - before->second - 1;
      }
      if (header.sequence) last_sequences_[name] = *header.sequence;
    } catch (const InputError& error) {
      losses_.note_refused(error.what());
    }
  }

  LogInfo& info_;
  LossAccount& losses_;
  std::map<std::string, std::int64_t> last_sequences_;
};

double seconds(std::int64_t microseconds) {
  return static_cast<double>(microseconds) * 1e-6;
}

double megabytes(std::uint64_t bytes) {
  return static_cast<double>(bytes) * 1e-6;
}

std::string date_of(std::int64_t utime) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(static_cast<std::time_t>(utime / 1'000'000)));
}

}  // namespace

double ChannelInfo::rate_hz() const {
  return last > first ? static_cast<double>(messages - 1) / seconds(last - first) : 0.0;
}

LogInfo read_log_info(const std::filesystem::path& log_file, LossAccount& losses) {
  LogInfo info;
  info.file = log_file.string();
  GoodEvents events(log_file, losses);
  info.file_bytes = std::filesystem::file_size(log_file);
  Counter counter(info, losses);
  while (const std::optional<LogEvent> event = events.next()) counter.add(*event);
  return info;
}

std::string to_text(const LogInfo& info) {
  std::string text =
      fmt::format("{}: {:.1f} MB, {} events in {:.2f} s from {}\n", info.file, megabytes(info.file_bytes), info.events,
                  seconds(info.last - info.first), date_of(info.first));
  text += fmt::format("{:<28} {:<30} {:>8} {:>8} {:>9} {:>9}  {}\n", "channel", "type", "messages", "Hz", "MB",
                      "kB each", "longest gap");
  for (const auto& [name, channel] : info.channels) {
    const double mean_kb = static_cast<double>(channel.bytes) / static_cast<double>(channel.messages) * 1e-3;
    text += fmt::format("{:<28} {:<30} {:>8} {:>8.2f} {:>9.2f} {:>9.2f}  ", name,
                        fmt::format("{}", fmt::join(channel.types, ", ")), channel.messages, channel.rate_hz(),
                        megabytes(channel.bytes), mean_kb);
    text += channel.messages < 2 ? "-\n"
                                 : fmt::format("{:.3f} s before {:.3f} s\n", seconds(channel.longest_gap),
                                               seconds(channel.gap_at - info.first));
  }
  for (const auto& [name, channel] : info.channels) {
    if (channel.frames.empty()) continue;
    text += fmt::format("{}: {}; {} frames missing in their numbering\n", name, channel.frames, channel.frames_lost);
  }
  return text;
}

}  // namespace houghstream::log_tools
