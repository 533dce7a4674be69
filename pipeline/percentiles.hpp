#pragma once

#include <vector>

namespace houghstream {

/// NaN where there are no values.
struct Percentiles {
  double p50 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
};

/// Nearest-rank percentiles: the smallest value that at least p per cent of the values do not exceed.
Percentiles percentiles(std::vector<double> values);

}  // namespace houghstream
