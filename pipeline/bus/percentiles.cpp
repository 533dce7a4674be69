#include "pipeline/bus/percentiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace houghstream {
namespace {

double of_sorted(const std::vector<double>& sorted, double percent) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(percent * 1e-2 * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

}  // namespace

double percentile(std::vector<double> values, double percent) {
  std::sort(values.begin(), values.end());
  return of_sorted(values, percent);
}

Percentiles percentiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {of_sorted(values, 50.0), of_sorted(values, 95.0), of_sorted(values, 99.0)};
}

}  // namespace houghstream
