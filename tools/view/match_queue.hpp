#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

#include "tools/view/frame_matcher.hpp"

namespace houghstream::view {

/// Hands matched frames from the thread that receives to the one that draws. When it is full the oldest is dropped.
class MatchQueue {
 public:
  explicit MatchQueue(std::size_t capacity) : capacity_(capacity) {}

  /// False when an older one had to be dropped.
  bool push(MatchedFrame frame) {
    const std::lock_guard lock(mutex_);
    const bool full = frames_.size() >= capacity_;
    if (full) frames_.pop_front();
    frames_.push_back(std::move(frame));
    arrived_.notify_one();
    return !full;
  }

  /// The oldest frame, or nothing when none comes within `timeout`.
  std::optional<MatchedFrame> pop(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    if (!arrived_.wait_for(lock, timeout, [this] { return !frames_.empty(); })) return std::nullopt;
    std::optional<MatchedFrame> frame = std::move(frames_.front());
    frames_.pop_front();
    return frame;
  }

 private:
  std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<MatchedFrame> frames_;
};

}  // namespace houghstream::view
