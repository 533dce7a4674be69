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

  /// Notes a status of one of the stream's own processes only, since anybody on the network may send a status of any
  /// other.
  void note(const status_t& status, Clock::time_point time);
  /// Forgets all processes but these.
  void keep(const std::vector<Supervisor::State>& states);

  /// Returns the stream in one line: rate, latency and losses of each process, or that it waits for the others or for
  /// its restart, or has sent no status for three seconds.
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

  /// Time to wait for the others: one second for each of four, and as much as hs-view lets a frame wait.
  static constexpr std::chrono::seconds kTimeout{7};

  /// `pids` are those of the others, in that order.
  DrainMonitor(std::vector<pid_t> pids, Clock::time_point ended);

  void note(const status_t& status, Clock::time_point heard);

  bool is_drained() const { return through_ == pids_.size(); }

 private:
  std::vector<pid_t> pids_;
  std::size_t through_ = 0;  // number of processes that are drained
  Clock::time_point since_;  // time at which the last of these was drained, or the source ended
};

}  // namespace houghstream::stream
