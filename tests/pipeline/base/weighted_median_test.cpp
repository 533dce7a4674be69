#include "pipeline/base/weighted_median.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

using Values = std::vector<std::pair<float, float>>;

/// Returns the median by sorting; weights are whole numbers, whose sums are exact.
float sorted_median(Values values) {
  std::sort(values.begin(), values.end());
  float total = 0.0F;
  for (const auto& [value, weight] : values) total += weight;
  float sum = 0.0F;
  for (const auto& [value, weight] : values) {
    sum += weight;
    if (sum >= 0.5F * total) return value;
  }
  return 0.0F;
}

TEST(WeightedMedian, IsThatOfTheSortedValues) {
  Random random(2);
  for (int count = 0; count < 200; ++count) {
    Values values;
    values.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      values.emplace_back(static_cast<float>(random.below(50)), static_cast<float>(random.between(1, 9)));
    }
    const float expected = sorted_median(values);
    EXPECT_EQ(weighted_median(values), expected) << count;
  }
}

TEST(WeightedMedian, AHeavyValueWins) {
  Values values = {{3.0F, 1.0F}, {1.0F, 1.0F}, {2.0F, 5.0F}, {9.0F, 2.0F}};
  EXPECT_EQ(weighted_median(values), 2.0F);
  Values none;
  EXPECT_EQ(weighted_median(none), 0.0F);
}

}  // namespace
}  // namespace houghstream
