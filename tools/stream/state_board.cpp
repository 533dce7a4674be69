#include "tools/stream/state_board.hpp"

#include <fmt/format.h>

#include <cmath>

namespace houghstream::stream {
namespace {

std::string describe(const status_t& status) {
  std::string text = fmt::format("{:.1f} Hz", status.rate_hz);
  if (std::isfinite(status.latency_p50_ms)) text += fmt::format(" {:.0f} ms", status.latency_p50_ms);
  if (status.frames_lost > 0) text += fmt::format(", {} lost", status.frames_lost);
  if (status.frames_refused > 0) text += fmt::format(", {} refused: {}", status.frames_refused, status.last_error);
  return text;
}

}  // namespace

void StateBoard::note(const status_t& status, Clock::time_point time) {
  entries_[status.pid] = {status, time};
}

std::string StateBoard::line(const std::vector<Supervisor::State>& states, Clock::time_point now) const {
  constexpr std::chrono::seconds kStale(3);
  std::string line;
  for (const Supervisor::State& state : states) {
    const auto entry = entries_.find(state.pid);
    std::string text = "silent";
    if (state.pid == 0) {
      text = "down";
    } else if (entry != entries_.end() && now - entry->second.time < kStale) {
      text = describe(entry->second.status);
    }
    line += fmt::format("{}{} {}", line.empty() ? "" : " | ", state.name, text);
    if (state.restarts > 0) line += fmt::format(" (restarts: {})", state.restarts);
  }
  return line;
}

}  // namespace houghstream::stream
