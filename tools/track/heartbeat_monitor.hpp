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

/// A moment in microseconds of the clock that nobody sets.
inline std::int64_t steady_us(std::chrono::steady_clock::time_point moment) {
  return std::chrono::duration_cast<std::chrono::microseconds>(moment.time_since_epoch()).count();
}

/// Processes that find objects, and those of them that have fallen silent. May be used from any thread.
class HeartbeatMonitor {
 public:
  /// Takes note of a process' status. What is no status is somebody else's.
  void on_status(const ReceivedMessage& arrival);

  /// Names of those that have been silent for too long since they were asked for last; each is told once. `now_us` as
  /// steady_us() has it.
  std::vector<std::string> pop_timed_out(std::int64_t now_us);

  /// Logs those.
  void log_timed_out(std::int64_t now_us);

 private:
  static constexpr std::size_t kProcesses = 64;  // a sender of rubbish may make up numbers without end

  std::mutex mutex_;
  std::map<std::string, std::int64_t> last_;
  LogThrottle lines_;
};

}  // namespace houghstream::track
