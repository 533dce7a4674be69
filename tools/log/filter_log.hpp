#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include "tools/log/good_events.hpp"

namespace houghstream::log_tools {

struct LogFilter {
  double start_s = 0.0;  ///< seconds since the log's first event
  double end_s = std::numeric_limits<double>::infinity();
  std::string channels = ".*";  ///< a ChannelPattern
  bool others = false;          ///< keep the channels that do not match instead
};

/// Copies the events that pass, unchanged, to another log. Returns their number. Throws InputError where the expression
/// is none, nothing passes, or a file cannot be used.
std::int64_t filter_log(const std::filesystem::path& log_file, const LogFilter& filter,
                        const std::filesystem::path& out_file, LossAccount& losses);

}  // namespace houghstream::log_tools
