#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/base/log_throttle.hpp"
#include "pipeline/bus/lcm_bus.hpp"

namespace houghstream::track {

/// Returns a time of the steady clock, microseconds.
inline std::int64_t steady_us(std::chrono::steady_clock::time_point moment) {
  return std::chrono::duration_cast<std::chrono::microseconds>(moment.time_since_epoch()).count();
}

/// Heartbeats of the processes that detect objects, with a timeout. May be used from any thread.
class HeartbeatMonitor {
 public:
  /// Records the heartbeat of a process' status; other messages are ignored.
  void on_status(const ReceivedMessage& arrival);

  /// Returns the processes whose heartbeat has timed out since the last call; each is returned once. `now_us` is a time
  /// of steady_us().
  std::vector<std::string> pop_timed_out(std::int64_t now_us);

  /// Logs the processes whose heartbeat has timed out.
  void log_timed_out(std::int64_t now_us);

 private:
  static constexpr std::size_t kProcesses = 64;  // an untrusted sender may make up numbers without end

  std::mutex mutex_;
  std::map<std::string, std::int64_t> last_;
  LogThrottle throttle_;
};

}  // namespace houghstream::track
