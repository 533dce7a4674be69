#pragma once

#include <algorithm>
#include <cmath>

namespace houghstream {

/// Log odds of a probability, which is brought to [margin, 1 - margin] first: exactly 0 or 1 is not certainty.
inline double logit(double probability, double margin = 0.001) {
  const double p = std::clamp(probability, margin, 1.0 - margin);
  return std::log(p / (1.0 - p));
}

/// The probability of log odds.
inline double logistic(double odds) {
  return 1.0 / (1.0 + std::exp(-odds));
}

}  // namespace houghstream
