#include "pipeline/process/pair_inbox.hpp"

#include <algorithm>
#include <utility>

namespace houghstream {

void PairInbox::put_frame(std::int64_t utime, std::vector<std::uint8_t> bytes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    frames_.push_back({utime, std::move(bytes)});
    if (frames_.size() > kHistory) frames_.pop_front();
    ++frames_seen_;
    fresh_ = newest_first_;
    drop_hopeless();
  }
  changed_.notify_one();
}

void PairInbox::put_detections(std::int64_t utime, std::vector<std::uint8_t> bytes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back({utime, std::move(bytes), std::chrono::steady_clock::now(), frames_seen_});
    drop_hopeless();
  }
  changed_.notify_one();
}

std::optional<FramePair> PairInbox::take(std::chrono::milliseconds timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  std::optional<std::size_t> found;
  changed_.wait_for(lock, timeout, [&] {
    found = next_complete();
    return found.has_value() || fresh_;
  });
  if (!found) return std::nullopt;
  return take_pair(*found);
}

std::optional<ArrivedFrame> PairInbox::take_fresh() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!std::exchange(fresh_, false)) return std::nullopt;
  return frames_.back();
}

PairInbox::Dropped PairInbox::take_dropped() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(dropped_, {});
}

void PairInbox::give_up_waiting() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const Waiting& waiting : waiting_) {
    if (find_frame(waiting.utime) == nullptr) {
      dropped_.without_frame.push_back(waiting.utime);
    } else {
      ++dropped_.skipped;
    }
  }
  waiting_.clear();
}

const ArrivedFrame* PairInbox::find_frame(std::int64_t utime) const {
  const auto found =
      std::find_if(frames_.begin(), frames_.end(), [&](const ArrivedFrame& f) { return f.utime == utime; });
  return found == frames_.end() ? nullptr : &*found;
}

std::optional<std::size_t> PairInbox::next_complete() const {
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const std::size_t index = newest_first_ ? waiting_.size() - 1 - i : i;
    if (find_frame(waiting_[index].utime) != nullptr) return index;
  }
  return std::nullopt;
}

void PairInbox::drop_hopeless() {
  // The second condition bounds memory where detections come and frames do not.
  while (!waiting_.empty() && find_frame(waiting_.front().utime) == nullptr &&
         (frames_seen_ - waiting_.front().frames_before > kWait || waiting_.size() > kHistory)) {
    dropped_.without_frame.push_back(waiting_.front().utime);
    waiting_.pop_front();
  }
}

FramePair PairInbox::take_pair(std::size_t index) {
  const auto chosen = waiting_.begin() + static_cast<std::ptrdiff_t>(index);
  if (chosen->utime == frames_.back().utime) fresh_ = false;
  FramePair pair{find_frame(chosen->utime)->bytes, std::move(chosen->bytes), chosen->arrival};
  if (newest_first_) {
    dropped_.skipped += static_cast<std::int64_t>(index);
    waiting_.erase(waiting_.begin(), chosen + 1);
  } else {
    waiting_.erase(chosen);
  }
  return pair;
}

}  // namespace houghstream
