#include "pipeline/process/latest_slot.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace houghstream {
namespace {

using std::chrono::milliseconds;

TEST(LatestSlot, TheNewestWinsAndWhatIsPassedOverIsTold) {
  LatestSlot<int> slot;
  EXPECT_FALSE(slot.put(1));
  EXPECT_TRUE(slot.put(2));
  EXPECT_TRUE(slot.put(3));
  EXPECT_EQ(slot.take(milliseconds(0)), 3);
  EXPECT_FALSE(slot.take(milliseconds(1)).has_value());
  EXPECT_FALSE(slot.put(4));
}

TEST(LatestSlot, EveryItemIsTakenOrPassedOver) {
  LatestSlot<int> slot;
  constexpr int kItems = 20000;
  int passed_over = 0;
  std::thread sender([&] {
    for (int i = 1; i <= kItems; ++i) passed_over += slot.put(i) ? 1 : 0;
  });
  int taken = 0;
  int last = 0;
  while (last < kItems) {
    const std::optional<int> item = slot.take(milliseconds(1000));
    ASSERT_TRUE(item.has_value());
    EXPECT_GT(*item, last);
    last = *item;
    ++taken;
  }
  sender.join();
  EXPECT_EQ(taken + passed_over, kItems);
}

}  // namespace
}  // namespace houghstream
