#include "tools/stream/state_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/base/printable.hpp"

namespace houghstream::stream {
namespace {

std::string describe(const status_t& status) {
  constexpr std::size_t kMaxErrorLength = 300;
  std::string text = fmt::format("{:.1f} Hz", status.rate_hz);
  if (std::isfinite(status.latency_p50_ms)) text += fmt::format(" {:.0f} ms", status.latency_p50_ms);
  if (status.frames_lost > 0) text += fmt::format(", {} lost", status.frames_lost);
  if (status.frames_refused > 0)
    text +=
        fmt::format(", {} refused: {}", status.frames_refused, printable(status.last_error.substr(0, kMaxErrorLength)));
  return text;
}

}  // namespace

void StatusBoard::note(const status_t& status, Clock::time_point time) {
  entries_[status.pid] = {status, time};
}

void StatusBoard::keep(const std::vector<Supervisor::State>& states) {
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const bool is_known = std::any_of(states.begin(), states.end(),
                                      [&](const Supervisor::State& state) { return state.pid == entry->first; });
    entry = is_known ? std::next(entry) : entries_.erase(entry);
  }
}

std::string StatusBoard::line(const std::vector<Supervisor::State>& states, Clock::time_point now) const {
  constexpr std::chrono::seconds kStale(3);
  std::string line;
  for (const Supervisor::State& state : states) {
    const auto entry = entries_.find(state.pid);
    std::string text = "silent";
    if (state.waits) {
      text = "waits for the others";
    } else if (state.pid == 0) {
      text = "down";
    } else if (entry != entries_.end() && now - entry->second.time < kStale) {
      text = describe(entry->second.status);
    }
    line += fmt::format("{}{} {}", line.empty() ? "" : " | ", state.name, text);
    if (state.restarts > 0) line += fmt::format(" (restarts: {})", state.restarts);
  }
  return line;
}

DrainMonitor::DrainMonitor(std::vector<pid_t> pids, Clock::time_point ended) : pids_(std::move(pids)), since_(ended) {}

void DrainMonitor::note(const status_t& status, Clock::time_point heard) {
  constexpr std::chrono::milliseconds kOnTheWay(100);  // earlier messages have arrived by then
  if (is_drained() || status.pid != pids_[through_] || heard - since_ < kOnTheWay) return;
  const bool is_idle =
      status.frames_received == status.frames_processed + status.frames_skipped + status.frames_refused;
  if (!is_idle) return;
  ++through_;
  since_ = heard;
}

}  // namespace houghstream::stream
