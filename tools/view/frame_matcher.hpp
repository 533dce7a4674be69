#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/process/detector_count.hpp"
#include "pipeline/types/frame_results.hpp"

namespace houghstream::view {

/// Settings of the frames that wait for their results.
struct MatchSettings {
  double rate_hz = 10.0;                ///< maximum rate of the frames that are handed out
  std::int64_t wait_us = 500'000;       ///< a frame waits at least so long for its results
  std::int64_t silence_us = 2'000'000;  ///< time without messages after which no process is assumed to send them
  std::int64_t kept_us = 3'000'000;     ///< a frame is forgotten after this
  std::size_t kept_bytes = std::size_t{192} << 20U;  ///< encoded frames and results that wait; the oldest frames go
};

/// A frame as it came off the bus, with what was published about it.
struct MatchedFrame {
  FrameId id;
  std::vector<std::uint8_t> frame_bytes;  ///< the encoded images_t; decoded only when drawn
  std::int64_t arrival_us = 0;            ///< time of the frame's arrival, local clock
  std::int64_t slot = 0;                  ///< arrival in units of 1/rate_hz since the first frame
  FrameResults results;
  std::size_t bytes = 0;           ///< size of the frame and its results, encoded
  int detections_heard = 0;        ///< messages
  double detect_latency_ms = 0.0;  ///< time from the frame's arrival to its last detections'; meaningless without any
  double pose_latency_ms = 0.0;    ///< time from the frame's arrival to its last poses'; meaningless without any
};

/// Joins frames with their detections and poses by the frame's name, those of all detectors that work on the camera.
/// Times are handed in, in microseconds of one clock. Not thread-safe.
class FrameMatcher {
 public:
  explicit FrameMatcher(MatchSettings settings);

  void add_frame(const FrameId& id, std::vector<std::uint8_t> bytes, std::int64_t now_us);
  /// `bytes` is the size of the message.
  void add_detections(Detections detections, std::int64_t now_us, std::size_t bytes = 0);
  void add_poses(ObjectPoses poses, std::int64_t now_us, std::size_t bytes = 0);

  /// Returns the next frame worth drawing, in order of arrival, at most `rate_hz` a second: one with the poses of as
  /// many detectors as there are, as soon as these are there; one with fewer after `wait_us`; one with detections only,
  /// or with nothing, when no poses or no detections at all have come for as long as `silence_us`.
  std::optional<MatchedFrame> next(std::int64_t now_us);

  /// Frames that were forgotten without having been handed out.
  std::int64_t passed_over() const { return passed_over_; }

 private:
  using Waiting = std::map<FrameId, MatchedFrame>;

  bool ready(const MatchedFrame& frame, std::int64_t now_us) const;
  MatchedFrame* frame_with_room(const FrameId& id, std::size_t bytes);
  Waiting::iterator forget(Waiting::iterator frame);
  void keep_within_bytes();

  MatchSettings settings_;
  Waiting waiting_;
  std::size_t bytes_ = 0;  ///< size of all waiting frames
  DetectorCount detectors_;
  std::optional<std::int64_t> first_arrival_us_;
  std::int64_t last_slot_ = -1;
  std::int64_t passed_over_ = 0;
  std::int64_t last_detections_us_ = 0;  ///< arrival of the last detections, or of the first frame
  std::int64_t last_poses_us_ = 0;       ///< arrival of the last poses, or of the first frame
};

/// Hands matched frames from the thread that receives to the one that draws. When it is full the oldest are dropped.
class MatchedFrameQueue {
 public:
  /// `capacity` frames, and fewer where they and their results have more than so many bytes.
  MatchedFrameQueue(std::size_t capacity, std::size_t max_bytes) : capacity_(capacity), max_bytes_(max_bytes) {}

  /// Adds a frame and returns the number of older ones that were dropped.
  std::int64_t push(MatchedFrame frame) {
    const std::lock_guard lock(mutex_);
    std::int64_t dropped = 0;
    for (; !frames_.empty() && (frames_.size() >= capacity_ || bytes_ + frame.bytes > max_bytes_); ++dropped) {
      take_first();
    }
    bytes_ += frame.bytes;
    frames_.push_back(std::move(frame));
    arrived_.notify_one();
    return dropped;
  }

  /// Returns the oldest frame, or nothing when none comes within `timeout`.
  std::optional<MatchedFrame> pop(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_for(lock, timeout, [this] { return !frames_.empty(); })) return std::nullopt;
    return take_first();
  }

 private:
  MatchedFrame take_first() {
    MatchedFrame frame = std::move(frames_.front());
    frames_.pop_front();
    bytes_ -= frame.bytes;
    return frame;
  }

  std::size_t capacity_;
  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<MatchedFrame> frames_;
};

}  // namespace houghstream::view
