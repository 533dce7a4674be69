#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace houghstream {

/// Returns the value with half the weight below it; 0 where there are no values. `values` are pairs of value and
/// weight, and are reordered: only the part in which the median lies is visited again, which is faster than to sort
/// all.
template <typename Real>
Real weighted_median(std::vector<std::pair<Real, Real>>& values) {
  Real total = 0;
  for (const auto& [value, weight] : values) total += weight;
  Real below = 0;
  auto begin = values.begin();
  auto end = values.end();
  while (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end);
    Real sum = below;
    for (auto value = begin; value != middle; ++value) sum += value->second;
    if (sum >= total / 2) {
      end = middle;
    } else {
      begin = middle;
      below = sum;
    }
  }
  return begin == end ? Real(0) : begin->first;
}

}  // namespace houghstream
