#pragma once

#include <vector>

namespace houghstream {

struct Percentiles {
  double p50 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
};

/// Returns the nearest-rank percentile: the smallest value that at least `percent` per cent of the values do not
/// exceed; NaN where there are no values.
double percentile(std::vector<double> values, double percent);

Percentiles percentiles(std::vector<double> values);

}  // namespace houghstream
