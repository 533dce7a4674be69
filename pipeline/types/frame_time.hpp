#pragma once

#include <cstdint>
#include <limits>

namespace houghstream {

/// Seconds by which newer frames of a camera may overtake one on its way; what is older has come of a clock that was
/// set back, or of a source that begins again.
constexpr double kMaxOvertakenS = 1.0;

/// Returns `utime` + `by_us`, microseconds, clamped to the range of the type, since the times of a message or a damaged
/// log may be any.
inline std::int64_t shifted(std::int64_t utime, std::int64_t by_us) {
  std::int64_t sum = 0;
  if (!__builtin_add_overflow(utime, by_us, &sum)) return sum;
  return by_us > 0 ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
}

}  // namespace houghstream
