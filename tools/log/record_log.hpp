#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace houghstream::log_tools {

struct RecordSettings {
  std::string file;                   ///< log to write
  std::vector<std::string> channels;  ///< ChannelPatterns, of which one has to match; empty = all channels
  std::string url;                    ///< LCM URL of a network; "" = LCM's default
  double seconds = 0.0;               ///< time to record; 0 = until a stop signal
  bool replace = false;               ///< replace a log of this name instead of taking the next free one
};

/// Account of a recording.
struct RecordResult {
  std::string file;  ///< final name of the log
  std::int64_t events = 0;
  std::int64_t bytes = 0;                           ///< of messages
  std::map<std::string, std::int64_t> frames_lost;  ///< frames that their numbering says are missing, by channel
  std::int64_t unwritten = 0;                       ///< messages that came faster than the disk takes them
  std::optional<std::int64_t> dropped;  ///< datagrams that the kernel had no room for; nothing where it does not say

  std::size_t channels = 0;  ///< number of channels with messages

  bool is_complete() const;
  /// Returns one line about losses and the remedy, or "nothing was lost", as far as it is known.
  std::string losses_line() const;
};

/// Records messages of a network to an LCM log until a stop signal, or for so long, with the times of their reception.
/// Messages are received at once and written by a thread of its own; with root's rights the receive buffer goes beyond
/// the kernel's limit. What is lost all the same is counted. A log whose name is taken gets the next number
/// (Existing::kRecordingKept). Throws InputError where the URL is that of a log, no message comes, or the disk refuses:
/// what was recorded until then is kept beside the log.
RecordResult record_log(const RecordSettings& settings);

}  // namespace houghstream::log_tools
