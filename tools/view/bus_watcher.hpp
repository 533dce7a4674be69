#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "pipeline/lcm_bus.hpp"
#include "tools/view/match_queue.hpp"

namespace houghstream {

/// Listens to frames, detections and poses in a thread of its own, so that slow drawing never delays receiving.
class BusWatcher {
 public:
  /// Starts to listen. `waiting_frames` may queue up to be drawn. Throws InputError where the network cannot be used.
  BusWatcher(const std::string& lcm_url, const std::string& frame_channel, const MatchSettings& match,
             std::size_t waiting_frames);
  ~BusWatcher();
  BusWatcher(const BusWatcher&) = delete;
  BusWatcher& operator=(const BusWatcher&) = delete;

  /// The next frame to draw, or nothing when none comes within `timeout`.
  std::optional<MatchedFrame> next(std::chrono::milliseconds timeout) { return queue_.pop(timeout); }

  /// Stops listening; frames that wait can still be taken.
  void stop();

  /// Frames that were not drawn because drawing was too slow.
  std::int64_t dropped() const { return queue_.dropped(); }

 private:
  void subscribe(const std::string& frame_channel);
  void listen();

  LcmBus bus_;
  FrameMatcher matcher_;
  MatchQueue queue_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace houghstream
