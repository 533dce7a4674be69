#pragma once

namespace houghstream {

inline constexpr double kRadPerDeg = 0.017453292519943295;

}  // namespace houghstream
