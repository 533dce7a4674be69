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
  static constexpr std::size_t kMaxResults = 64;  ///< above it the oldest is dropped

  void add(Detections detections) {
    const std::lock_guard<std::mutex> lock(mutex_);
    results_.push_back(std::move(detections));
    if (results_.size() > kMaxResults) results_.pop_front();
  }

  /// Removes the detections of frames of this id: a new frame has come, from a source that repeats its stamps.
  void forget(const FrameId& frame) {
    const std::lock_guard<std::mutex> lock(mutex_);
    results_.erase(std::remove_if(results_.begin(), results_.end(),
                                  [&](const Detections& result) { return result.frame == frame; }),
                   results_.end());
  }

  /// Returns the detections of all detectors in the frame.
  Detections find(const FrameId& frame) const {
    Detections all;
    all.frame = frame;
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const Detections& result : results_) {
      if (result.frame == frame)
        all.detections.insert(all.detections.end(), result.detections.begin(), result.detections.end());
    }
    return all;
  }

 private:
  mutable std::mutex mutex_;
  std::deque<Detections> results_;
};

}  // namespace houghstream::track
