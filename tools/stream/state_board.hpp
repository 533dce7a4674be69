#pragma once

#include <chrono>
#include <houghstream/status_t.hpp>
#include <map>
#include <string>
#include <vector>

#include "tools/stream/supervisor.hpp"

namespace houghstream::stream {

/// What the processes say of themselves, and since when.
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

}  // namespace houghstream::stream
