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
    ++found.suppressed;
    return std::nullopt;
  }
  found.last = now;
  const std::int64_t suppressed = std::exchange(found.suppressed, 0);
  return suppressed == 0 ? line : fmt::format("{} (and {} more not shown)", line, suppressed);
}

std::int64_t LogThrottle::suppressed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::int64_t sum = 0;
  for (const auto& [kind, state] : kinds_) sum += state.suppressed;
  return sum;
}

}  // namespace houghstream
