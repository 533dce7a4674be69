#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "drivers/files/json_file.hpp"
#include "tools/log/good_events.hpp"

namespace houghstream::log_tools {

/// Summarises the messages of one channel.
struct ChannelInfo {
  std::set<std::string> types;  ///< names of type_name()
  std::int64_t messages = 0;
  std::uint64_t bytes = 0;
  std::int64_t first = 0;        ///< timestamp, microseconds since the epoch
  std::int64_t last = 0;         ///< timestamp of the latest
  std::int64_t max_gap = 0;      ///< longest interval between two messages, microseconds
  std::int64_t gap_at = 0;       ///< timestamp of the message after that gap
  std::string frames;            ///< description of the first frame; "" where the channel holds none
  std::int64_t frames_lost = 0;  ///< lost frames, from gaps in the source's numbering

  /// Returns messages per second between the first and the latest; 0 for a single one.
  double rate_hz() const;
};

struct LogInfo {
  std::string file;
  std::uint64_t file_bytes = 0;
  std::int64_t events = 0;
  std::int64_t first = 0;  ///< timestamps, microseconds since the epoch
  std::int64_t last = 0;
  std::map<std::string, ChannelInfo> channels;
};

/// Reads a log through; damage goes to `losses`. Throws InputError when the file cannot be read or holds no event.
LogInfo read_log_info(const std::filesystem::path& log_file, LossReport& losses);

/// Returns a table for people, with times from the log's first event.
std::string to_text(const LogInfo& info);

/// Returns the same for scripts: times in microseconds since the epoch (_utime) and seconds (_s), sizes in bytes,
/// channels by name. Values that a channel of a single message lacks are null.
OrderedJson to_json(const LogInfo& info);

}  // namespace houghstream::log_tools
