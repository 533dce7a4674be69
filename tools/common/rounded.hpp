#pragma once

#include <cmath>

namespace houghstream {

/// Rounds to so many decimals, for figures in reports; NaN and infinity stay what they are.
inline double rounded(double value, int decimals) {
  const double unit = std::pow(10.0, decimals);
  return std::round(value * unit) / unit;
}

}  // namespace houghstream
