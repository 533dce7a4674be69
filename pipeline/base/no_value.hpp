#pragma once

#include <limits>

namespace houghstream {

/// What stands where nothing was measured: depth without a return, a normal or colour that is not known. Ask for it by
/// std::isfinite or std::isnan, it equals nothing.
inline constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

}  // namespace houghstream
