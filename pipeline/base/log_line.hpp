#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace houghstream {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// Starts logging to stderr, each line with the time and `name`; lines below `minimum` are left out.
void start_log(const std::string& name, LogLevel minimum);

/// Leaves out all but errors from here on, unless debug lines were asked for.
void hush_log();

/// Logs one line. spdlog writes it, but lines are composed here: with values handed to spdlog, each source that logs
/// instantiates fmt's formatting again, and takes two seconds longer to compile. Control characters of a terminal are
/// shown as \xNN, since names and errors come off the wire.
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
