#pragma once

#include <lcm/eventlog.h>

#include <cstdint>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/base/files.hpp"
#include "pipeline/messages/wire_reader.hpp"

namespace houghstream {

struct LogEvent;

/// A sealed log holds, before every block of events, one more on this channel: eight bytes "HSSEAL1\0", u32 number of
/// events, and for each of them the CRC-32 of its timestamp (i64), channel and data; numbers big-endian. It reveals
/// flipped bits and missing events; it is no signature, since anybody can make one. Stock players play it as a message
/// that nobody receives.
inline const std::string kSealChannel = "HOUGHSTREAM_SEAL";
constexpr std::size_t kSealedBlock = 256;  ///< events, at most

/// Copies a whole log and seals it: from then on every reader of ours refuses an event of which a bit has changed, and
/// a log of which events are missing. Returns the number of events. Throws InputError where the log is damaged, since
/// damaged data are not sealed. `tell`, if any, is called after each event with the sealed fraction of the log.
std::int64_t seal_log(const std::filesystem::path& log_file, const std::filesystem::path& out_file,
                      const std::function<void(double fraction)>& tell = {});

std::uint32_t checksum_of(const LogEvent& event);

std::vector<std::uint8_t> encode_seal(const std::vector<std::uint32_t>& checksums);

/// Checksums of the events that follow, in their order. Throws InputError, naming `source`, where it is no whole seal.
std::vector<std::uint32_t> decode_seal(ByteView bytes, const std::string& source);

/// Holds one message of a log.
struct LogEvent {
  std::int64_t timestamp = 0;  ///< reception time, microseconds since the epoch
  std::string channel;
  std::vector<std::uint8_t> data;
};

/// Writes a log in LCM's event log format, which stock lcm-logplayer replays: for each event a header of 28 bytes
/// big-endian (0xEDA1DA01, number i64, timestamp i64, channel length u32, data length u32), channel, data. The log is
/// there as a whole once it is closed (AtomicFile), and not at all where it is not.
class LogWriter {
 public:
  /// Throws InputError when the file cannot be made.
  explicit LogWriter(const std::filesystem::path& file, Existing existing = Existing::kReplaced);
  /// Return the final name of the log, and the one that is written until then.
  const std::filesystem::path& file() const { return whole_.file(); }
  const std::filesystem::path& partial() const { return whole_.partial(); }
  /// Throws InputError when the disk refuses, or no reader would take a channel of this name.
  void write(std::int64_t timestamp, const std::string& channel, ByteView data);
  /// Pushes everything to the file, checks that it arrived there, and ends the log. Throws InputError.
  void close();
  /// Ends the writing instead of close() and keeps the data as FILE.partial, since a recording cannot be repeated.
  void keep_partial();
  [[deprecated("is keep_partial() now")]] void keep() { keep_partial(); }

 private:
  struct Closer {
    void operator()(lcm_eventlog_t* log) const;
  };
  AtomicFile whole_;
  std::string file_;
  std::unique_ptr<lcm_eventlog_t, Closer> log_;
};

/// Reads an LCM event log event by event. LCM's own reader cannot distinguish the end of a log from damage; this one
/// can, and in a sealed log (seal_log) it detects damage within events too. The seals themselves are not returned.
class LogReader {
 public:
  /// Throws InputError when the file cannot be read or is empty.
  explicit LogReader(const std::filesystem::path& file);
  /// Returns the next event, or nothing at the end. Throws InputError where the log is cut or damaged.
  std::optional<LogEvent> next();
  /// Returns the bytes before the next event, and those of the whole file.
  std::uint64_t position() const { return position_; }
  std::uint64_t size() const { return size_; }
  /// Returns whether a seal has been read so far.
  bool is_sealed() const { return is_sealed_; }

  /// Bytes that skip_damage() skipped.
  struct Damage {
    std::uint64_t bytes = 0;
    bool last_event_too = false;  ///< the event that next() returned last was damaged itself: it held later ones
  };

  /// Skips to the next position that is an event, or to the end, after next() has thrown. Throws InputError where the
  /// file cannot be read.
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
  std::uint64_t position_ = 0;       // position of the next event
  std::uint64_t last_position_ = 0;  // position of the event returned last
  std::uint64_t looked_again_ = 0;   // bytes that were searched once more for events
  std::int64_t events_ = 0;
  bool is_sealed_ = false;
  std::deque<std::uint32_t> seals_;  // checksums of the events that follow
  bool is_unlike_seal_ = false;      // the last event: nothing else is to be passed over
};

}  // namespace houghstream
