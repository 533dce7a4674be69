#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

namespace houghstream {

/// Encoded detections with the encoded frame of the same utime.
struct FramePair {
  std::vector<std::uint8_t> frame;
  std::vector<std::uint8_t> detections;
  std::chrono::steady_clock::time_point arrival;  ///< of the detections
};

/// An encoded frame.
struct ArrivedFrame {
  std::int64_t utime = 0;
  std::vector<std::uint8_t> bytes;
};

/// Brings detections together with their own frame, whichever comes first. Nothing is decoded. Ages are counted in
/// frames, not in seconds, so that a log gives the same pairs at any speed.
class PairInbox {
 public:
  /// Frames that are kept for detections still to come.
  static constexpr std::size_t kHistory = 64;
  /// Detections whose frame is not here wait for this many further frames, then are given up.
  static constexpr std::int64_t kWait = 30;

  /// `newest_first`: take() passes over older detections; otherwise everything is worked on in turn.
  explicit PairInbox(bool newest_first) : newest_first_(newest_first) {}

  void put_frame(std::int64_t utime, std::vector<std::uint8_t> bytes);
  void put_detections(std::int64_t utime, std::vector<std::uint8_t> bytes);

  /// The next pair, waiting for one up to `timeout`, or, with `newest_first`, until a frame comes.
  std::optional<FramePair> take(std::chrono::milliseconds timeout);

  /// The newest frame, where `newest_first`, and where neither it nor its pair has been taken: there is time to decode
  /// it while its detections are on the way. It stays here for them.
  std::optional<ArrivedFrame> take_fresh();

  /// What was dropped since the last call.
  struct Dropped {
    std::int64_t skipped = 0;                 ///< passed over for newer ones
    std::vector<std::int64_t> without_frame;  ///< utimes of detections whose frame never came
  };
  Dropped take_dropped();

  /// Gives up all detections that still wait for their frame.
  void give_up_waiting();

 private:
  struct Waiting {
    std::int64_t utime = 0;
    std::vector<std::uint8_t> bytes;
    std::chrono::steady_clock::time_point arrival;
    std::int64_t frames_before = 0;  // frames that had arrived when it did
  };

  const ArrivedFrame* find_frame(std::int64_t utime) const;
  std::optional<std::size_t> next_complete() const;
  void drop_hopeless();
  FramePair take_pair(std::size_t index);

  bool newest_first_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<ArrivedFrame> frames_;
  bool fresh_ = false;  // the last of them
  std::deque<Waiting> waiting_;
  std::int64_t frames_seen_ = 0;
  Dropped dropped_;
};

}  // namespace houghstream
