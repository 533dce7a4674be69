#include "pipeline/process/latest_per_channel.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace houghstream {
namespace {

using std::chrono::milliseconds;

TEST(LatestPerChannel, TheNewestWinsAndWhatIsPassedOverIsTold) {
  LatestPerChannel<int> slot;
  EXPECT_FALSE(slot.push("A", 1));
  EXPECT_TRUE(slot.push("A", 2));
  EXPECT_TRUE(slot.push("A", 3));
  EXPECT_EQ(slot.pop(milliseconds(0)), 3);
  EXPECT_FALSE(slot.pop(milliseconds(1)).has_value());
  EXPECT_FALSE(slot.push("A", 4));
}

TEST(LatestPerChannel, EveryItemIsTakenOrPassedOver) {
  LatestPerChannel<int> slot;
  constexpr int kItems = 20000;
  int passed_over = 0;
  std::thread sender([&] {
    for (int i = 1; i <= kItems; ++i) passed_over += slot.push("A", i) ? 1 : 0;
  });
  int taken = 0;
  int last = 0;
  while (last < kItems) {
    const std::optional<int> item = slot.pop(milliseconds(1000));
    ASSERT_TRUE(item.has_value());
    EXPECT_GT(*item, last);
    last = *item;
    ++taken;
  }
  sender.join();
  EXPECT_EQ(taken + passed_over, kItems);
}

TEST(LatestPerChannel, AFastChannelDoesNotStarveASlowOne) {
  LatestPerChannel<int> slots;
  EXPECT_FALSE(slots.push("SLOW", 1));
  EXPECT_FALSE(slots.push("FAST", 10));
  for (int i = 11; i < 20; ++i) EXPECT_TRUE(slots.push("FAST", i));
  EXPECT_EQ(slots.waiting(), 2U);
  EXPECT_EQ(slots.pop(milliseconds(0)), 1);
  EXPECT_FALSE(slots.push("SLOW", 2));
  EXPECT_TRUE(slots.push("FAST", 20)) << "a newer item takes the turn of the one before";
  EXPECT_EQ(slots.pop(milliseconds(0)), 20);
  EXPECT_EQ(slots.pop(milliseconds(0)), 2);
  EXPECT_EQ(slots.waiting(), 0U);
}

TEST(LatestPerChannel, WhatWasOvertakenGivesWay) {
  LatestPerChannel<int> slot;
  slot.push("A", 3);
  EXPECT_TRUE(slot.push_late("A", 2)) << "the newer one waits";
  EXPECT_EQ(slot.pop(milliseconds(0)), 3);
  EXPECT_FALSE(slot.push_late("A", 2));
  EXPECT_EQ(slot.pop(milliseconds(0)), 2);
}

TEST(LatestPerChannel, HoldsAFewChannelsOnly) {
  LatestPerChannel<int> slot;
  for (std::size_t i = 0; i < LatestPerChannel<int>::kChannels; ++i) EXPECT_FALSE(slot.push(std::to_string(i), 1));
  EXPECT_TRUE(slot.push("one more", 1));
  EXPECT_TRUE(slot.push("0", 2));
  EXPECT_EQ(slot.waiting(), LatestPerChannel<int>::kChannels);
}

TEST(LatestPerChannel, LargeItemsOfManyChannelsAreKeptWithinABound) {
  constexpr std::size_t kBytes = LatestPerChannel<int>::kBytes;
  LatestPerChannel<int> slots;
  EXPECT_FALSE(slots.push("A", 1, 2 * kBytes)) << "one alone may be as large as it is";
  EXPECT_TRUE(slots.push("B", 2, 1));
  EXPECT_TRUE(slots.push("A", 3, kBytes - 1)) << "the one before gives way";
  EXPECT_FALSE(slots.push("B", 4, 1));
  EXPECT_TRUE(slots.push_late("C", 5, 1));
  EXPECT_EQ(slots.pop(milliseconds(0)), 3);
  EXPECT_FALSE(slots.push_late("C", 6, kBytes - 1));
  EXPECT_EQ(slots.pop(milliseconds(0)), 4);
  EXPECT_EQ(slots.pop(milliseconds(0)), 6);
}

}  // namespace
}  // namespace houghstream
