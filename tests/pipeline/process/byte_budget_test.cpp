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
    const ByteBudget::Reservation some = count.reserve(3);
    const ByteBudget::Reservation more = count.reserve(4);
    EXPECT_EQ(some.bytes(), 3U);
    EXPECT_EQ(count.total(), 7U);
  }
  EXPECT_EQ(count.total(), 0U);
  EXPECT_EQ(ByteBudget::Reservation().bytes(), 0U);
}

TEST(ByteBudget, MovesWithItsItem) {
  ByteBudget count;
  ByteBudget::Reservation first = count.reserve(3);
  {
    const ByteBudget::Reservation taken = std::move(first);
    EXPECT_EQ(taken.bytes(), 3U);
    EXPECT_EQ(count.total(), 3U);
  }
  EXPECT_EQ(count.total(), 0U);
}

TEST(ByteBudget, IsGivenBackByWhatIsReplaced) {
  ByteBudget count;
  std::map<std::string, ByteBudget::Reservation> items;
  items.insert_or_assign("LEFT", count.reserve(3));
  items.insert_or_assign("LEFT", count.reserve(5));
  EXPECT_EQ(count.total(), 5U);
  EXPECT_FALSE(items.emplace("LEFT", count.reserve(7)).second);
  EXPECT_EQ(count.total(), 5U);
  items.clear();
  EXPECT_EQ(count.total(), 0U);
}

TEST(ByteBudget, IsGivenBackByWhatIsDropped) {
  ByteBudget count;
  std::deque<ByteBudget::Reservation> items;
  for (const unsigned bytes : {1U, 2U, 4U, 8U, 16U}) items.push_back(count.reserve(bytes));
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
