#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace houghstream {

/// Holds the newest item of each channel between two threads. LCM's own queue would keep the oldest instead, and a slow
/// receiver would lag behind further and further. Channels are served in turn: a fast one does not starve the others.
template <typename T>
class NewestOfEach {
 public:
  /// Channels whose items wait at once; the item of one more is passed over. A sender of rubbish may make up channels.
  static constexpr std::size_t kChannels = 64;

  /// Returns whether an item that nobody has taken was passed over. The newer one of a channel takes its turn.
  bool put(const std::string& channel, T item) {
    bool is_first = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_full_for(channel)) return true;
      is_first = items_.insert_or_assign(channel, std::move(item)).second;
      if (is_first) turns_.push_back(channel);
    }
    filled_.notify_one();
    return !is_first;
  }

  /// An item that newer ones have overtaken: it is taken where none waits. Returns whether it was passed over.
  bool put_late(const std::string& channel, T item) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_full_for(channel) || !items_.emplace(channel, std::move(item)).second) return true;
      turns_.push_back(channel);
    }
    filled_.notify_one();
    return false;
  }

  /// The item of the channel that has waited longest; waits up to `timeout` for one.
  std::optional<T> take(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!filled_.wait_for(lock, timeout, [this] { return !turns_.empty(); })) return std::nullopt;
    std::optional<T> item = std::move(items_.extract(turns_.front()).mapped());
    turns_.pop_front();
    return item;
  }

  /// Items that nobody has taken.
  std::size_t waiting() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return turns_.size();
  }

 private:
  bool is_full_for(const std::string& channel) const {
    return items_.size() >= kChannels && items_.count(channel) == 0;
  }

  mutable std::mutex mutex_;
  std::condition_variable filled_;
  std::map<std::string, T> items_;
  std::deque<std::string> turns_;  // channels with an item, the longest waiting first
};

}  // namespace houghstream
