#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "tools/view/frame_matcher.hpp"

namespace houghstream {

/// Hands matched frames from the thread that receives to the one that draws. When it is full the oldest is dropped.
class MatchQueue {
 public:
  explicit MatchQueue(std::size_t capacity) : capacity_(capacity) {}

  void push(MatchedFrame frame) {
    const std::lock_guard lock(mutex_);
    if (frames_.size() >= capacity_) {
      frames_.pop_front();
      ++dropped_;
    }
    frames_.push_back(std::move(frame));
    arrived_.notify_one();
  }

  /// The oldest frame, or nothing when none comes within `timeout`.
  std::optional<MatchedFrame> pop(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_for(lock, timeout, [this] { return !frames_.empty(); })) return std::nullopt;
    std::optional<MatchedFrame> frame = std::move(frames_.front());
    frames_.pop_front();
    return frame;
  }

  std::int64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  std::size_t capacity_;
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<MatchedFrame> frames_;
  std::int64_t dropped_ = 0;
};

}  // namespace houghstream
