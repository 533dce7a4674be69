#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>

namespace houghstream {

/// Messages that come before the results which they belong to; the last 64 are kept. For one thread at a time.
template <typename Message>
class LastMessages {
 public:
  void add(Message message) {
    constexpr std::size_t kMax = 64;
    messages_.push_front(std::move(message));
    if (messages_.size() > kMax) messages_.pop_back();
  }

  /// Returns the newest message that is wanted; null where none is.
  template <typename IsWanted>
  const Message* find(const IsWanted& is_wanted) const {
    const auto found = std::find_if(messages_.begin(), messages_.end(), is_wanted);
    return found == messages_.end() ? nullptr : &*found;
  }

 private:
  std::deque<Message> messages_;  // the newest first
};

}  // namespace houghstream
