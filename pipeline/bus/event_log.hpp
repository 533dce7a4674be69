#pragma once

#include <lcm/eventlog.h>

#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/files.hpp"
#include "pipeline/messages/wire_reader.hpp"

namespace houghstream {

/// One message of a log.
struct LogEvent {
  std::int64_t timestamp = 0;  ///< when it was received, microseconds since the epoch
  std::string channel;
  std::vector<std::uint8_t> data;
};

/// Writes a log in LCM's event log format, which stock lcm-logplayer replays: for each event a header of 28 bytes
/// big-endian (0xEDA1DA01, number i64, timestamp i64, channel length u32, data length u32), channel, data. The log is
/// there as a whole once it is closed (WholeFile), and not at all where it is not.
class LogWriter {
 public:
  /// Throws InputError when the file cannot be made.
  explicit LogWriter(const std::filesystem::path& file, Existing existing = Existing::kReplaced);
  /// Where the log will be, and where it is written until then.
  const std::filesystem::path& file() const { return whole_.file(); }
  const std::filesystem::path& partial() const { return whole_.partial(); }
  /// Throws InputError when the disk refuses, or no reader would take a channel of this name.
  void write(std::int64_t timestamp, const std::string& channel, ByteView data);
  /// Pushes everything to the file, checks that it arrived there, and ends the log. Throws InputError.
  void close();
  /// Instead of close(): what was written stays as FILE.partial, for what cannot be had again.
  void keep();

 private:
  struct Closer {
    void operator()(lcm_eventlog_t* log) const;
  };
  WholeFile whole_;
  std::string file_;
  std::unique_ptr<lcm_eventlog_t, Closer> log_;
};

/// Reads an LCM event log event by event. LCM's own reader cannot tell the end of a log from damage; this one can, and
/// of a sealed log (log_seal.hpp) it tells damage within its events too. The seals themselves are not given.
class LogReader {
 public:
  /// Throws InputError when the file cannot be read or is empty.
  explicit LogReader(const std::filesystem::path& file);
  /// The next event, or nothing at the end. Throws InputError where the log is cut or damaged.
  std::optional<LogEvent> next();
  /// Bytes before the next event, and of the whole file.
  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }
  /// Whether a seal has come so far.
  bool is_sealed() const { return is_sealed_; }

  /// What skip_damage() passed over.
  struct Damage {
    std::uint64_t bytes = 0;
    bool last_event_too = false;  ///< the event that next() returned last was damaged itself: it held later ones
  };

  /// After next() has thrown: goes to the next place that is an event, or to the end. Throws InputError where the file
  /// cannot be read.
  Damage skip_damage();

 private:
  /// Lengths that an event's header states.
  struct Header {
    std::int64_t timestamp = 0;
    std::uint32_t channel_bytes = 0;
    std::uint32_t data_bytes = 0;
  };
  Header read_header();
  std::optional<LogEvent> read_event();
  void break_seal(const LogEvent& event);
  bool is_event_at(std::uint64_t position);
  std::optional<std::uint64_t> find_event(std::uint64_t from);
  void seek(std::uint64_t position);

  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::string file_;
  std::unique_ptr<std::FILE, Closer> in_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;       // of the next event
  std::uint64_t last_position_ = 0;  // of the event returned last
  std::uint64_t looked_again_ = 0;   // bytes that were searched once more for events
  std::int64_t events_ = 0;
  bool is_sealed_ = false;
  std::deque<std::uint32_t> seals_;  // checksums of the events that follow
  bool is_unlike_seal_ = false;      // the last event: nothing else is to be passed over
};

}  // namespace houghstream
