#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "tools/view/frame_matcher.hpp"

namespace houghstream::view {

/// Hands matched frames from the thread that receives to the one that draws. When it is full the oldest are dropped.
class MatchedFrameQueue {
 public:
  /// `capacity` frames, and fewer where they and their results have more than so many bytes.
  MatchedFrameQueue(std::size_t capacity, std::size_t max_bytes) : capacity_(capacity), max_bytes_(max_bytes) {}

  /// How many older ones had to be dropped.
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

  /// The oldest frame, or nothing when none comes within `timeout`.
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
