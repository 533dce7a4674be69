#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/text/limited_lines.hpp"

namespace houghstream::track {

/// Processes that find objects, and those of them that have fallen silent. May be used from any thread.
class Silence {
 public:
  /// Takes note of a process' status. What is no status is somebody else's.
  void hear(const Arrival& arrival);

  /// Names of those that have been silent for too long since they were asked for last; each is told once. `now_us` is
  /// on the clock of the arrivals' event_us.
  std::vector<std::string> fallen_silent(std::int64_t now_us);

  /// Logs those.
  void tell(std::int64_t now_us);

 private:
  static constexpr std::size_t kProcesses = 64;  // a sender of rubbish may make up numbers without end

  std::mutex mutex_;
  std::map<std::string, std::int64_t> last_;
  LimitedLines lines_;
};

}  // namespace houghstream::track
