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
  /// Channels whose items wait at once; the item of one more is passed over. A sender of rubbish may make up channels.
  static constexpr std::size_t kChannels = 64;
  /// Bytes of those that wait at once, as they are stated; one alone may have more.
  static constexpr std::size_t kBytes = std::size_t{192} << 20U;

  /// Pushes an item. Returns whether an item, this or an older one, was dropped without being popped. The newer one of
  /// a channel keeps its turn.
  bool push(const std::string& channel, T item, std::size_t bytes = 0) {
    bool is_first = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_full_for(channel, bytes)) return true;
      is_first = items_.insert_or_assign(channel, Waiting{std::move(item), bytes_.reserve(bytes)}).second;
      if (is_first) turns_.push_back(channel);
    }
    filled_.notify_one();
    return !is_first;
  }

  /// Pushes an overtaken item; it is dropped if the channel has an item already, or where too many wait. Returns
  /// whether it was dropped.
  bool push_late(const std::string& channel, T item, std::size_t bytes = 0) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (is_full_for(channel, bytes)) return true;
      if (!items_.emplace(channel, Waiting{std::move(item), bytes_.reserve(bytes)}).second) return true;
      turns_.push_back(channel);
    }
    filled_.notify_one();
    return false;
  }

  /// Pops the item of the channel that has waited longest; waits up to `timeout` for one.
  std::optional<T> pop(std::chrono::milliseconds timeout) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!filled_.wait_for(lock, timeout, [this] { return !turns_.empty(); })) return std::nullopt;
    Waiting taken = std::move(items_.extract(turns_.front()).mapped());
    turns_.pop_front();
    return std::move(taken.item);
  }

  /// Returns the number of items that have not been popped.
  std::size_t waiting() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return turns_.size();
  }

 private:
  struct Waiting {
    T item;
    ByteBudget::Reservation reservation;
  };

  bool is_full_for(const std::string& channel, std::size_t bytes) const {
    const auto known = items_.find(channel);
    const bool is_known = known != items_.end();
    if (!is_known && items_.size() >= kChannels) return true;
    const std::size_t others = items_.size() - (is_known ? 1 : 0);
    return others > 0 && bytes_.total() - (is_known ? known->second.reservation.bytes() : 0) + bytes > kBytes;
  }

  mutable std::mutex mutex_;
  std::condition_variable filled_;
  ByteBudget bytes_;
  std::map<std::string, Waiting> items_;
  std::deque<std::string> turns_;  // channels with an item, the longest waiting first
};

}  // namespace houghstream
