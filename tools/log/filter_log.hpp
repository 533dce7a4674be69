#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "tools/log/good_events.hpp"

namespace houghstream::log_tools {

struct LogFilter {
  std::optional<double> start_s;  ///< seconds since the log's first event; nothing = from its beginning
  std::optional<double> end_s;    ///< end; nothing = the log's end
  std::string channels = ".*";    ///< a ChannelPattern
  bool others = false;            ///< keep the channels that do not match instead
};

/// Copies the events that pass, unchanged, to another log. Returns their number. Without a time every event of the
/// channels passes, whatever its date. Events that are dated before the first one, or jump by more than an hour (a
/// clock that was set, a damaged header), are reported in `losses`. A first event whose date is far from those behind
/// it is not the origin of the seconds. Throws InputError where the expression is invalid, nothing passes, or a file
/// cannot be used.
std::int64_t filter_log(const std::filesystem::path& log_file, const LogFilter& filter,
                        const std::filesystem::path& out_file, LossReport& losses);

}  // namespace houghstream::log_tools
