#include "pipeline/base/log_line.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <memory>

#include "pipeline/base/printable.hpp"
#include "pipeline/base/terminal_colour.hpp"

namespace houghstream {
namespace {

spdlog::level::level_enum to_spdlog(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug: return spdlog::level::debug;
    case LogLevel::kInfo: return spdlog::level::info;
    case LogLevel::kWarning: return spdlog::level::warn;
    case LogLevel::kError: return spdlog::level::err;
  }
  return spdlog::level::err;
}

}  // namespace

void start_log(const std::string& name, LogLevel minimum) {
  const auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>(
      shows_colours(STDERR_FILENO) ? spdlog::color_mode::always : spdlog::color_mode::never);
  for (const spdlog::level::level_enum level : {spdlog::level::debug, spdlog::level::info})
    sink->set_color(level, sink->reset);  // warnings are yellow, errors red
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(name, sink));
  spdlog::set_pattern("%H:%M:%S.%e %^%n:%$ %v");
  spdlog::set_level(to_spdlog(minimum));
}

void hush_log() {
  if (spdlog::get_level() > spdlog::level::debug) spdlog::set_level(spdlog::level::err);
}

void log_line(LogLevel level, const std::string& line) {
  const std::string shown = printable_lines(line);
  spdlog::log(to_spdlog(level), spdlog::string_view_t(shown));
}

}  // namespace houghstream
