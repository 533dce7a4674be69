#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

#include "pipeline/process/pose_output.hpp"

namespace houghstream {

/// The last decoded frames of all cameras, for the detections that come a little later. May be used from any thread.
class RecentFrames {
 public:
  using Decoded = std::shared_ptr<const DecodedFrame>;

  /// A decoded frame has some megabytes, and a sender of rubbish may make up channels without end.
  static constexpr std::size_t kFrames = 12;
  static constexpr std::size_t kBytes = std::size_t{192} << 20U;  ///< of their images; the newest stays in any case

  void keep(Decoded frame) {
    const std::lock_guard<std::mutex> lock(mutex_);
    bytes_ += bytes_of(frame->frame);
    frames_.push_back(std::move(frame));
    while (frames_.size() > kFrames || (frames_.size() > 1 && bytes_ > kBytes)) {
      bytes_ -= bytes_of(frames_.front()->frame);
      frames_.pop_front();
    }
  }

  /// The newest of that name; null where it is not there any more.
  Decoded find(const FrameId& id) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found =
        std::find_if(frames_.rbegin(), frames_.rend(), [&](const Decoded& decoded) { return decoded->frame.id == id; });
    return found == frames_.rend() ? nullptr : *found;
  }

 private:
  static std::size_t bytes_of(const RgbdFrame& frame) {
    return frame.colour.total() * frame.colour.elemSize() + frame.depth.total() * frame.depth.elemSize();
  }

  mutable std::mutex mutex_;
  std::deque<Decoded> frames_;
  std::size_t bytes_ = 0;
};

}  // namespace houghstream
