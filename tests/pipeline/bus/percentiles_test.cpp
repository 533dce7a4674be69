#include "pipeline/bus/percentiles.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace houghstream {
namespace {

TEST(Percentiles, AreNearestRanks) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  const Percentiles p = percentiles(values);
  EXPECT_EQ(p.p50, 50.0);
  EXPECT_EQ(p.p95, 95.0);
  EXPECT_EQ(p.p99, 99.0);
  EXPECT_EQ(percentiles({7.0}).p99, 7.0);
}

TEST(Percentiles, OneOfThemIsAnyShareAskedFor) {
  const std::vector<double> values = {30.0, 10.0, 20.0, 40.0};
  EXPECT_EQ(percentile(values, 0.0), 10.0);
  EXPECT_EQ(percentile(values, 25.0), 10.0);
  EXPECT_EQ(percentile(values, 26.0), 20.0);
  EXPECT_EQ(percentile(values, 90.0), 40.0);
  EXPECT_EQ(percentile(values, 100.0), 40.0);
}

TEST(Percentiles, OfNothingAreNone) {
  EXPECT_TRUE(std::isnan(percentiles({}).p50));
  EXPECT_TRUE(std::isnan(percentile({}, 10.0)));
}

}  // namespace
}  // namespace houghstream
