#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <tuple>

namespace houghstream {

/// The name of a frame, by which everything pairs, keeps, draws, exports and judges. The time alone does not name it:
/// cameras that are triggered together, simulated or replayed take frames of equal times.
struct FrameId {
  std::string channel;     ///< the camera's: LCM channel of the frame; empty where it was not published
  std::int64_t utime = 0;  ///< capture time, microseconds since the epoch
};

inline bool operator==(const FrameId& a, const FrameId& b) {
  return a.utime == b.utime && a.channel == b.channel;
}
inline bool operator!=(const FrameId& a, const FrameId& b) {
  return !(a == b);
}
/// Orders earlier frames first, and frames of one time by their channels.
inline bool operator<(const FrameId& a, const FrameId& b) {
  return std::tie(a.utime, a.channel) < std::tie(b.utime, b.channel);
}

/// Returns "LEFT_CAMERA 1499876543210000", or the time alone where there is no channel.
inline std::string to_string(const FrameId& id) {
  return (id.channel.empty() ? "" : id.channel + " ") + std::to_string(id.utime);
}

/// Returns `to` - `from`, microseconds, clamped to the range of the type, since the times of a message or a damaged log
/// may be any.
inline std::int64_t microseconds_between(std::int64_t from, std::int64_t to) {
  std::int64_t between = 0;
  if (!__builtin_sub_overflow(to, from, &between)) return between;
  return to > from ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
}

/// Returns the seconds from one time in microseconds to another.
inline double seconds_between(std::int64_t from, std::int64_t to) {
  return static_cast<double>(microseconds_between(from, to)) * 1e-6;
}

}  // namespace houghstream

template <>
struct std::hash<houghstream::FrameId> {
  std::size_t operator()(const houghstream::FrameId& id) const noexcept {
    return std::hash<std::string>()(id.channel) * 31 + std::hash<std::int64_t>()(id.utime);
  }
};
