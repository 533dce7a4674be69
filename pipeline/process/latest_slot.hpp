#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

namespace houghstream {

/// Holds one item between two threads; the newest wins. LCM's own queue would keep the oldest instead, and a slow
/// receiver would lag behind further and further.
template <typename T>
class LatestSlot {
 public:
  /// Returns whether an item that nobody has taken was passed over.
  bool put(T item) {
    bool replaced = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      replaced = item_.has_value();
      item_ = std::move(item);
    }
    filled_.notify_one();
    return replaced;
  }

  /// Waits up to `timeout` for an item.
  std::optional<T> take(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    filled_.wait_for(lock, timeout, [this] { return item_.has_value(); });
    return std::exchange(item_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::condition_variable filled_;
  std::optional<T> item_;
};

}  // namespace houghstream
