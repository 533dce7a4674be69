#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "pipeline/bus/event_log.hpp"
#include "tools/common/progress_line.hpp"

namespace houghstream::log_tools {

/// Ends a job that SIGINT or SIGTERM asks to stop, so that it leaves no part of its output behind.
class Stopped : public std::runtime_error {
 public:
  Stopped() : std::runtime_error("stopped") {}
};

/// Throws Stopped where one of the signals waits, which it does while BlockStopSignals holds it back.
void require_not_stopped();

/// Events of a recording that could not be kept.
class LossReport {
 public:
  void note_damage(std::uint64_t bytes, const std::string& reason);
  /// Notes a message or frame that arrived whole and cannot be understood.
  void note_refused(const std::string& reason);

  std::int64_t damaged_places() const { return damaged_places_; }
  std::int64_t refused() const { return refused_; }
  /// Something that looks wrong, though nothing is lost by it.
  void add_warning(const std::string& words) { oddities_ += (oddities_.empty() ? "" : "; ") + words; }

  /// Returns one line about losses, their reasons and warnings, or "" where there are none.
  std::string line() const;

 private:
  std::int64_t damaged_places_ = 0;
  std::uint64_t damaged_bytes_ = 0;
  std::int64_t refused_ = 0;
  std::string first_damage_;
  std::string first_refusal_;
  std::string oddities_;
};

/// Reads the events of a log that are whole, and continues behind damage. Shows its progress on stderr.
class IntactEvents {
 public:
  /// `losses` must outlive it. Throws InputError when the file cannot be read or is empty.
  IntactEvents(const std::filesystem::path& file, LossReport& losses);

  /// Returns the next whole event, or nothing at the end. Throws InputError when the file holds none at all, and
  /// Stopped.
  std::optional<LogEvent> next();

 private:
  std::optional<LogEvent> read();

  std::filesystem::path file_;
  LogReader log_;
  LossReport& losses_;
  ProgressLine progress_;
  std::optional<LogEvent> held_;  // handed out once the next event has begun where this one ends
  bool ended_ = false;
  std::int64_t count_ = 0;
};

}  // namespace houghstream::log_tools
