#pragma once

#include <algorithm>
#include <cmath>

namespace houghstream {

/// Returns the logit of a probability after clamping it to [margin, 1 - margin], so that exactly 0 or 1 gives no
/// infinity.
inline double logit(double probability, double margin = 0.001) {
  const double p = std::clamp(probability, margin, 1.0 - margin);
  return std::log(p / (1.0 - p));
}

/// Returns the probability of a logit.
inline double logistic(double odds) {
  return 1.0 / (1.0 + std::exp(-odds));
}

}  // namespace houghstream
