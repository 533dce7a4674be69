#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <optional>
#include <string>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// What a frame's source says of it.
struct FrameNumber {
  std::optional<std::int64_t> sequence;  ///< the source's frame counter, if it has one
  std::int64_t utime = 0;                ///< of the frame, microseconds
  std::int64_t run = 0;                  ///< of the source: another one begins counting anew; 0 = it does not say
};

/// How a frame follows those before it.
enum class FrameOrder {
  kNext,       ///< newer than all before
  kLate,       ///< of those that were overtaken on the way
  kDuplicate,  ///< has come before: to be dropped, and counted as none
};

/// Counts the frames of a source that were sent and have not come, from their numbers, after the way in which RTP does
/// (RFC 3550, appendix A.1). What is overtaken counts as lost until it comes. A number that lies far from those before
/// it (forged, or of a sender that was started again) is not believed until its successor has come, and numbers a
/// hundred thousand apart are no loss, but another beginning. A frame whose number, time and run have come within the
/// last second is a duplicate. Not thread-safe.
class SequenceCount {
 public:
  /// `now_us`: when it arrived, on a clock that does not jump, microseconds.
  FrameOrder note(const FrameNumber& frame, std::int64_t now_us);

  /// Frames that have not come; nothing where no frame has had a number.
  std::optional<std::int64_t> lost() const;

 private:
  /// Numbers that are remembered behind the newest.
  static constexpr std::int64_t kWindow = 64;
  struct Seen {
    std::int64_t number = -1;
    std::int64_t utime = 0;
    std::int64_t arrival_us = 0;
  };
  struct Run {
    std::int64_t id = 0;
    std::int64_t first = 0;
    std::int64_t newest = 0;
    std::int64_t jump_from = 0;  // before the last gaps: they are taken back where what follows goes on from there
    std::int64_t jump_lost = 0;
    std::array<Seen, kWindow> seen;  // by number modulo the window
    std::optional<FrameNumber> candidate;
    std::int64_t candidate_us = 0;
  };

  Run& run_of(const FrameNumber& frame, std::int64_t number, bool& is_new);
  FrameOrder note_in(Run& run, const FrameNumber& frame, std::int64_t number, std::int64_t now_us);
  FrameOrder note_far(Run& run, const FrameNumber& frame, std::int64_t number, std::int64_t now_us);
  static void mark(Run& run, std::int64_t number, std::int64_t utime, std::int64_t now_us);

  std::list<Run> runs_;  // the one heard last first
  std::int64_t lost_ = 0;
  bool has_number_ = false;
};

/// Tells messages that a network has delivered twice: the same frame's, byte for byte, within a second. Not
/// thread-safe.
class RepeatedMessages {
 public:
  bool is_repeated(const FrameId& frame, const std::uint8_t* bytes, std::size_t size, std::int64_t now_us);

 private:
  struct Heard {
    FrameId frame;
    std::size_t hash = 0;
    std::int64_t arrival_us = 0;
  };
  std::deque<Heard> heard_;
};

}  // namespace houghstream
