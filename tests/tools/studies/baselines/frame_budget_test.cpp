#include "tools/studies/baselines/frame_budget.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <thread>

namespace houghstream {
namespace {

TEST(FrameBudget, TheOrderIsSpreadAndComplete) {
  EXPECT_EQ(spread_order(8), (std::vector<std::size_t>{0, 4, 2, 6, 1, 3, 5, 7}));
  for (const std::size_t count : {0U, 1U, 2U, 5U, 30U, 33U}) {
    std::vector<std::size_t> order = spread_order(count);
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> all(count);
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(order, all);
  }
}

TEST(FrameBudget, WithoutALimitAllAreVisited) {
  std::vector<std::size_t> seen;
  EXPECT_EQ(visit_within(0.0, 3, [&](std::size_t i) { seen.push_back(i); }), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 2, 1}));
}

TEST(FrameBudget, TheFirstIsVisitedAndThoseForWhichTimeIsLeft) {
  const auto slow = [](std::size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  EXPECT_EQ(visit_within(0.01, 8, slow), (std::vector<std::size_t>{0}));
  EXPECT_TRUE(visit_within(0.01, 0, slow).empty());
}

}  // namespace
}  // namespace houghstream
