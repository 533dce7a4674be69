#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace houghstream {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// From here on the log goes to stderr, each line with the time and `name`; what is below `minimum` is left out.
void start_log(const std::string& name, LogLevel minimum);

/// Leaves out all but errors from here on, unless debug lines were asked for.
void hush_log();

/// A line of the log. spdlog writes it, but lines are composed here: where spdlog is handed values, each source that
/// logs holds the whole of fmt's formatting again, and takes two seconds longer to compile. What would steer a terminal
/// is shown as \xNN: names and errors come off the wire.
void log_line(LogLevel level, const std::string& line);

template <typename... Args>
void log_debug(fmt::format_string<Args...> format, Args&&... args) {
  log_line(LogLevel::kDebug, fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void log_info(fmt::format_string<Args...> format, Args&&... args) {
  log_line(LogLevel::kInfo, fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void log_warning(fmt::format_string<Args...> format, Args&&... args) {
  log_line(LogLevel::kWarning, fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void log_error(fmt::format_string<Args...> format, Args&&... args) {
  log_line(LogLevel::kError, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace houghstream
