#pragma once

#include <chrono>
#include <cstdint>

namespace houghstream {

/// Returns the present time, in microseconds since the epoch on this machine's clock.
inline std::int64_t utime_now() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

/// Converts a time of the steady clock.
inline std::int64_t utime_of(std::chrono::steady_clock::time_point moment) {
  const auto ago = std::chrono::steady_clock::now() - moment;
  return utime_now() - std::chrono::duration_cast<std::chrono::microseconds>(ago).count();
}

}  // namespace houghstream
