#include "tools/stream/last_frames.hpp"

#include <utility>

namespace houghstream::stream {

DrainMonitor::DrainMonitor(std::vector<pid_t> pids, Clock::time_point ended) : pids_(std::move(pids)), since_(ended) {}

void DrainMonitor::note(const status_t& status, Clock::time_point heard) {
  constexpr std::chrono::milliseconds kOnTheWay(100);  // what was sent before has come by then
  if (is_drained() || status.pid != pids_[through_] || heard - since_ < kOnTheWay) return;
  const bool is_idle =
      status.frames_received == status.frames_processed + status.frames_skipped + status.frames_refused;
  if (!is_idle) return;
  ++through_;
  since_ = heard;
}

}  // namespace houghstream::stream
