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

#include "pipeline/process/byte_budget.hpp"

namespace houghstream {

/// Keeps the newest item of each channel between two threads (DDS KEEP_LAST with depth 1). LCM's queue would keep the
/// oldest instead, and a slow receiver would lag further and further. Channels are served in turn, so that a fast one
/// does not starve the others.
template <typename T>
class LatestPerChannel {
 public:
  /// Maximum number of channels with an item; an item of one more is dropped. An untrusted sender may make up channels.
  static constexpr std::size_t kChannels = 64;
  /// Maximum number of bytes of all items, as push() states them; a single item may have more.
  static constexpr std::size_t kBytes = std::size_t{192} << 20U;

  /// Pushes an item. Returns whether an item, this or an older one, was dropped without being popped. A newer
  /// item of a channel keeps its place in the order.
  bool push(const std::string& channel, T item, std::size_t bytes = 0) {
    bool is_first = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_full_for(channel, bytes)) return true;
      is_first = items_.insert_or_assign(channel, Entry{std::move(item), bytes_.reserve(bytes)}).second;
      if (is_first) order_.push_back(channel);
    }
    filled_.notify_one();
    return !is_first;
  }

  /// Pushes an overtaken item; it is dropped if the channel has an item already, or where there are too many. Returns
  /// whether it was dropped.
  bool push_late(const std::string& channel, T item, std::size_t bytes = 0) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_full_for(channel, bytes)) return true;
      if (!items_.emplace(channel, Entry{std::move(item), bytes_.reserve(bytes)}).second) return true;
      order_.push_back(channel);
    }
    filled_.notify_one();
    return false;
  }

  /// Pops the item of the channel that has waited longest; waits up to `timeout` for one.
  std::optional<T> pop(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!filled_.wait_for(lock, timeout, [this] { return !order_.empty(); })) return std::nullopt;
    Entry entry = std::move(items_.extract(order_.front()).mapped());
    order_.pop_front();
    return std::move(entry.item);
  }

  /// Returns the number of items that have not been popped.
  std::size_t waiting() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return order_.size();
  }

 private:
  struct Entry {
    T item;
    ByteBudget::Reservation reservation;
  };

  bool is_full_for(const std::string& channel, std::size_t bytes) const {
    const auto found = items_.find(channel);
    const bool is_known = found != items_.end();
    if (!is_known && items_.size() >= kChannels) return true;
    const std::size_t others = items_.size() - (is_known ? 1 : 0);
    return others > 0 && bytes_.total() - (is_known ? found->second.reservation.bytes() : 0) + bytes > kBytes;
  }

  mutable std::mutex mutex_;
  std::condition_variable filled_;
  ByteBudget bytes_;
  std::map<std::string, Entry> items_;
  std::deque<std::string> order_;  // channels with an item, that which has waited longest first
};

}  // namespace houghstream
