#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <houghstream/status_t.hpp>
#include <map>
#include <string>
#include <vector>

#include "tools/stream/supervisor.hpp"

namespace houghstream::stream {

/// Status of the processes, and its time.
class StatusBoard {
 public:
  using Clock = std::chrono::steady_clock;

  /// Only of the stream's own processes: anybody on the network may send a status of any other.
  void note(const status_t& status, Clock::time_point time);
  /// Forgets all processes but these.
  void keep(const std::vector<Supervisor::State>& states);

  /// The stream in one line: rate, latency and losses of each process, or that it waits for the others or for its
  /// restart, or has not been heard of for three seconds.
  std::string line(const std::vector<Supervisor::State>& states, Clock::time_point now) const;

 private:
  struct Entry {
    status_t status;
    Clock::time_point time;
  };
  std::map<pid_t, Entry> entries_;
};

/// Detects that a pipeline is drained after its source has ended, from the statuses of the processes: in the order of
/// the pipeline, each reports an empty queue a moment after the one before it. Each sends a status once a second. Not
/// thread-safe.
class DrainMonitor {
 public:
  using Clock = std::chrono::steady_clock;

  /// For which the others are waited for: one second for each of four, and as much as hs-view lets a frame wait.
  static constexpr std::chrono::seconds kTimeout{7};

  /// `pids`: of the others, in that order.
  DrainMonitor(std::vector<pid_t> pids, Clock::time_point ended);

  void note(const status_t& status, Clock::time_point heard);

  bool is_drained() const { return through_ == pids_.size(); }

 private:
  std::vector<pid_t> pids_;
  std::size_t through_ = 0;  // so many of them have nothing left to do
  Clock::time_point since_;  // when the last of these has said so, or the source has ended
};

}  // namespace houghstream::stream
