#include "pipeline/process/byte_budget.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <string>
#include <utility>

namespace houghstream {
namespace {

TEST(ByteBudget, CountsWhileItIsHeld) {
  ByteBudget count;
  {
    const ByteBudget::Held some = count.hold(3);
    const ByteBudget::Held more = count.hold(4);
    EXPECT_EQ(some.bytes(), 3U);
    EXPECT_EQ(count.total(), 7U);
  }
  EXPECT_EQ(count.total(), 0U);
  EXPECT_EQ(ByteBudget::Held().bytes(), 0U);
}

TEST(ByteBudget, MovesWithItsItem) {
  ByteBudget count;
  ByteBudget::Held first = count.hold(3);
  {
    const ByteBudget::Held taken = std::move(first);
    EXPECT_EQ(taken.bytes(), 3U);
    EXPECT_EQ(count.total(), 3U);
  }
  EXPECT_EQ(count.total(), 0U);
}

TEST(ByteBudget, IsGivenBackByWhatIsReplaced) {
  ByteBudget count;
  std::map<std::string, ByteBudget::Held> items;
  items.insert_or_assign("LEFT", count.hold(3));
  items.insert_or_assign("LEFT", count.hold(5));
  EXPECT_EQ(count.total(), 5U);
  EXPECT_FALSE(items.emplace("LEFT", count.hold(7)).second);
  EXPECT_EQ(count.total(), 5U);
  items.clear();
  EXPECT_EQ(count.total(), 0U);
}

TEST(ByteBudget, IsGivenBackByWhatIsDropped) {
  ByteBudget count;
  std::deque<ByteBudget::Held> items;
  for (const unsigned bytes : {1U, 2U, 4U, 8U, 16U}) items.push_back(count.hold(bytes));
  items.pop_front();
  EXPECT_EQ(count.total(), 30U);
  items.erase(items.begin() + 1);
  EXPECT_EQ(count.total(), 26U);
  items.erase(items.begin(), items.begin() + 2);
  EXPECT_EQ(count.total(), 16U);
  EXPECT_EQ(items.front().bytes(), 16U);
}

}  // namespace
}  // namespace houghstream
