#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <mutex>
#include <utility>

#include "pipeline/types/detection.hpp"

namespace houghstream::track {

/// Detections in the last frames of all cameras. May be used from any thread.
class RecentDetections {
 public:
  static constexpr std::size_t kKept = 64;  ///< results; of more the oldest goes

  void add(Detections detections) {
    const std::lock_guard<std::mutex> lock(mutex_);
    kept_.push_back(std::move(detections));
    if (kept_.size() > kKept) kept_.pop_front();
  }

  /// A frame has come: what is known under its name is of another one, of a source that stamps as before.
  void forget(const FrameId& frame) {
    const std::lock_guard<std::mutex> lock(mutex_);
    kept_.erase(std::remove_if(kept_.begin(), kept_.end(), [&](const Detections& some) { return some.frame == frame; }),
                kept_.end());
  }

  /// Returns the detections of all detectors in the frame.
  Detections of(const FrameId& frame) const {
    Detections all;
    all.frame = frame;
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const Detections& some : kept_) {
      if (some.frame == frame)
        all.detections.insert(all.detections.end(), some.detections.begin(), some.detections.end());
    }
    return all;
  }

 private:
  mutable std::mutex mutex_;
  std::deque<Detections> kept_;
};

}  // namespace houghstream::track
