#pragma once

#include <algorithm>
#include <utility>
#include <vector>

namespace houghstream {

/// The value with half the weight below it; 0 where there are no values. `values` are pairs of value and weight, and
/// are reordered: only the part in which the median lies is looked at again, which is faster than to sort all.
inline float weighted_median(std::vector<std::pair<float, float>>& values) {
  float total = 0.0F;
  for (const auto& [value, weight] : values) total += weight;
  float below = 0.0F;
  auto begin = values.begin();
  auto end = values.end();
  while (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end);
    float sum = below;
    for (auto value = begin; value != middle; ++value) sum += value->second;
    if (sum >= 0.5F * total) {
      end = middle;
    } else {
      begin = middle;
      below = sum;
    }
  }
  return begin == end ? 0.0F : begin->first;
}

}  // namespace houghstream
