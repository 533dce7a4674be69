#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <optional>
#include <string>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// Number and time that its source gives a frame.
struct FrameNumber {
  std::optional<std::int64_t> sequence;  ///< the source's frame counter, if it has one
  std::int64_t utime = 0;                ///< time of the frame, microseconds
  std::int64_t run = 0;                  ///< run of the source: each counts anew; 0 = not stated
};

/// Order of a frame relative to those before it.
enum class FrameOrder {
  kNext,       ///< newer than all before
  kLate,       ///< older than a frame that has arrived before it
  kDuplicate,  ///< has come before: to be dropped, and counted as none
};

/// Counts the lost frames of a source from their sequence numbers, as RTP does (RFC 3550, appendix A.1). An overtaken
/// frame counts as lost until it arrives. A number far from those before it (forged, or of a restarted sender) is on
/// probation until another one close to it has arrived; where the numbers then continue as before, the tracker returns
/// to the earlier range. A gap of more than a hundred thousand is a restart and no loss. A frame whose number, time and
/// run have arrived within the last second is a duplicate. Not thread-safe.
class SequenceTracker {
 public:
  /// Notes a frame and returns its order. `now_us` is its arrival time on a clock that does not jump, microseconds.
  FrameOrder note(const FrameNumber& frame, std::int64_t now_us);

  /// Frames that have not come; nothing where no frame has had a number.
  std::optional<std::int64_t> lost() const;

 private:
  /// Number of stored numbers behind the newest.
  static constexpr std::int64_t kWindow = 64;
  struct Seen {
    std::int64_t number = -1;
    std::int64_t utime = 0;
    std::int64_t arrival_us = 0;
  };
  /// Numbers that follow one another.
  struct SequenceRange {
    std::int64_t first = 0;
    std::int64_t newest = 0;
    std::int64_t lost = 0;           // including those lost before it
    std::array<Seen, kWindow> seen;  // frames by number modulo the window
  };
  struct Run {
    std::int64_t id = 0;
    SequenceRange range;
    std::list<SequenceRange> before;  // ranges before the last accepted jumps
    std::deque<Seen> probation;       // the last frames that lie far from it
  };

  Run& run_of(std::int64_t id, const Seen& frame, bool& is_new);
  static std::size_t slot(std::int64_t number);
  static bool is_duplicate(const Seen& seen, const Seen& frame);
  static bool has_place(const SequenceRange& range, std::int64_t number);
  static FrameOrder place(SequenceRange& range, const Seen& frame);
  static FrameOrder note_probation(Run& run, const Seen& frame);
  static void resync(Run& run, std::int64_t low, std::int64_t high);

  std::list<Run> runs_;    // the one heard last first
  std::int64_t lost_ = 0;  // lost frames of runs that are no longer stored
  bool has_number_ = false;
};

/// Detects messages that a network has delivered twice: of the same frame, equal byte for byte, within a second. Not
/// thread-safe.
class DuplicateFilter {
 public:
  using Clock = std::chrono::steady_clock;

  bool is_duplicate(const FrameId& frame, const std::uint8_t* bytes, std::size_t size, Clock::time_point arrival);

 private:
  struct Received {
    FrameId frame;
    std::size_t hash = 0;
    Clock::time_point arrival;
  };
  std::deque<Received> received_;
};

}  // namespace houghstream
