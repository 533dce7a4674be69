#pragma once

#include <chrono>
#include <cstdint>

namespace houghstream {

/// What a steady clock showed at some moment as a `utime`: microseconds since the epoch on this machine's clock.
inline std::int64_t utime_of(std::chrono::steady_clock::time_point moment) {
  const auto ago = std::chrono::steady_clock::now() - moment;
  const auto then = std::chrono::system_clock::now().time_since_epoch() - ago;
  return std::chrono::duration_cast<std::chrono::microseconds>(then).count();
}

inline std::int64_t utime_now() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

}  // namespace houghstream
