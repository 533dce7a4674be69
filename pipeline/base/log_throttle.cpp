#include "pipeline/base/log_throttle.hpp"

#include <fmt/format.h>

#include <utility>

namespace houghstream {

std::optional<std::string> LogThrottle::admit(const std::string& kind, const std::string& line, Clock::time_point now) {
  constexpr std::size_t kMaxKinds = 64;
  constexpr std::chrono::seconds kPeriod(1);
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool is_known = kinds_.count(kind) > 0 || kinds_.size() < kMaxKinds;
  Kind& found = kinds_[is_known ? kind : std::string()];
  if (found.last && now - *found.last < kPeriod) {
    ++found.held_back;
    return std::nullopt;
  }
  found.last = now;
  const std::int64_t held_back = std::exchange(found.held_back, 0);
  return held_back == 0 ? line : fmt::format("{} (and {} more not shown)", line, held_back);
}

std::int64_t LogThrottle::held_back() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::int64_t sum = 0;
  for (const auto& [kind, state] : kinds_) sum += state.held_back;
  return sum;
}

}  // namespace houghstream
