#pragma once

#include <limits>

namespace houghstream {

/// Value of what was not measured: depth without a return, an unknown normal or colour. It is NaN and equals nothing;
/// test with std::isfinite or std::isnan.
inline constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();

}  // namespace houghstream
