#include "pipeline/bus/sequence_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace houghstream {
namespace {

constexpr std::int64_t kFrameUs = 33'333;
constexpr std::int64_t kFramesOfADay = 2'592'000;  // forged numbers are as large as they can be, times are not

/// Frames as they arrive, 30 a second; a frame's utime goes with its number and `start`.
class Arrivals {
 public:
  FrameOrder come(std::int64_t number, std::int64_t run = 0, std::int64_t start = 0) {
    now_us_ += kFrameUs;
    const FrameOrder order = count.note({number, start + 1000 * (number % kFramesOfADay), run}, now_us_);
    if (order != FrameOrder::kDuplicate) ++received;
    return order;
  }
  void pass(std::int64_t us) { now_us_ += us; }

  SequenceTracker count;
  std::int64_t received = 0;

 private:
  std::int64_t now_us_ = 0;
};

TEST(SequenceTracker, GapsAreLost) {
  Arrivals arrivals;
  EXPECT_EQ(arrivals.count.lost(), std::nullopt) << "without a number it cannot be told";
  for (const std::int64_t number : {5, 6, 9, 10}) EXPECT_EQ(arrivals.come(number), FrameOrder::kNext);
  EXPECT_EQ(arrivals.count.lost(), 2);
}

TEST(SequenceTracker, WhatIsOvertakenIsLostUntilItComes) {
  Arrivals arrivals;
  for (const std::int64_t number : {0, 1, 4}) arrivals.come(number);
  EXPECT_EQ(arrivals.count.lost(), 2);
  EXPECT_EQ(arrivals.come(3), FrameOrder::kLate);
  EXPECT_EQ(arrivals.come(2), FrameOrder::kLate);
  EXPECT_EQ(arrivals.come(5), FrameOrder::kNext);
  EXPECT_EQ(arrivals.count.lost(), 0);
}

TEST(SequenceTracker, WhatComesTwiceCountsOnce) {
  Arrivals arrivals;
  for (const std::int64_t number : {0, 1, 2}) arrivals.come(number);
  EXPECT_EQ(arrivals.come(2), FrameOrder::kDuplicate);
  EXPECT_EQ(arrivals.come(1), FrameOrder::kDuplicate);
  EXPECT_EQ(arrivals.come(3), FrameOrder::kNext);
  EXPECT_EQ(arrivals.count.lost(), 0);
}

TEST(SequenceTracker, ForgedNumbersLoseNothing) {
  Arrivals arrivals;
  const std::int64_t largest = std::numeric_limits<std::int64_t>::max();
  for (std::int64_t number = 0; number < 300; ++number) {
    arrivals.come(number);
    if (number % 10 == 5) arrivals.come(number % 20 == 5 ? 1'000'000'000'000'000 : largest);
  }
  arrivals.come(largest - 1);
  arrivals.come(largest);
  for (std::int64_t number = 300; number < 310; ++number) arrivals.come(number);
  for (const std::int64_t number : {320, 420}) arrivals.count.note({number, 1, 0}, 0);  // not so far away
  for (std::int64_t number = 310; number < 500; ++number) arrivals.come(number);
  EXPECT_EQ(arrivals.count.lost(), 0);
}

TEST(SequenceTracker, ALongSilenceIsALoss) {
  Arrivals arrivals;
  arrivals.come(0);
  arrivals.come(5000);
  EXPECT_EQ(arrivals.count.lost(), 0) << "not believed yet";
  arrivals.come(5001);
  EXPECT_EQ(arrivals.count.lost(), 4999);
}

TEST(SequenceTracker, ASenderThatIsStartedAgainLosesNothingByIt) {
  for (const std::int64_t frames : {20, 200}) {
    for (const std::int64_t start : {0, 7'000'000}) {  // the times of a dataset are the same in each run
      Arrivals arrivals;
      for (std::int64_t number = 0; number < frames; ++number) arrivals.come(number);
      arrivals.pass(1'500'000);
      for (std::int64_t number = 0; number < frames; ++number) {
        if (number != 10) {
          EXPECT_EQ(arrivals.come(number, 0, start), FrameOrder::kNext) << number;
        }
      }
      EXPECT_EQ(arrivals.count.lost(), 1);
    }
  }
  Arrivals at_once;  // a stated new run needs no time between
  for (std::int64_t number = 0; number < 20; ++number) at_once.come(number, 1);
  for (std::int64_t number = 0; number < 20; ++number) EXPECT_EQ(at_once.come(number, 2), FrameOrder::kNext);
  EXPECT_EQ(at_once.count.lost(), 0);
}

// Sent = received + lost, whatever the way does to them.
TEST(SequenceTracker, IsExactUnderLossReorderingDuplicatesForgeriesAndRestarts) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    Arrivals arrivals;
    std::int64_t sent = 0;
    for (std::int64_t run = 1; run <= 3; ++run) {
      const std::int64_t frames = 100 + static_cast<std::int64_t>(random() % 400);
      std::vector<std::int64_t> way;
      for (std::int64_t number = 0; number < frames; ++number) {
        const bool is_end = number == 0 || number == frames - 1;  // losses there are unknown
        if (is_end || random() % 20 != 0) way.push_back(number);
        if (!way.empty() && random() % 10 == 0) way.push_back(way.back());
      }
      for (std::size_t i = 2; i + 2 < way.size(); ++i) {
        if (random() % 10 == 0) std::swap(way[i], way[i + random() % 2]);
      }
      for (const std::int64_t number : way) {
        arrivals.come(number, run);
        if (random() % 30 == 0) arrivals.count.note({std::int64_t{1} << (20 + random() % 43), 5, run}, 0);
      }
      sent += frames;
    }
    EXPECT_EQ(sent, arrivals.received + arrivals.count.lost().value()) << "seed " << seed;
  }
}

// Numbers closer to the range: a forged number that a lost frame had cannot be detected.
TEST(SequenceTracker, IsExactWhereForgeriesLieCloseBy) {
  const std::vector<std::int64_t> forged = {0, 1, 450, 470, 700, 99'000, 1'000'000, 1'000'000'000'000'000};
  for (unsigned seed = 1; seed <= 300; ++seed) {
    std::mt19937 random(seed);
    Arrivals arrivals;
    std::vector<std::int64_t> way;
    for (std::int64_t number = 0; number < 300; ++number) {
      const bool is_spared = number < 3 || number >= 297;
      if (is_spared || random() % 20 != 0) way.push_back(number);
      if (!is_spared && random() % 10 == 0) way.push_back(way.back());
    }
    for (std::size_t i = 4; i + 4 < way.size(); ++i) {
      if (random() % 10 == 0) std::swap(way[i], way[i + 1]);
    }
    std::int64_t sent = 300;
    for (std::size_t i = 0; i < way.size(); ++i) {
      arrivals.come(way[i]);
      if (i < 4 || i + 4 > way.size() || random() % 30 != 0) continue;
      arrivals.come(forged[random() % forged.size()], 0, 1'000 + way[i]);  // with a new time
      ++sent;
    }
    EXPECT_EQ(sent, arrivals.received + arrivals.count.lost().value()) << "seed " << seed;
  }
}

// A damaged log's events may be dated anyhow.
TEST(SequenceTracker, ArrivalsMayBeAsFarApartAsNumbersCanTell) {
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  SequenceTracker count;
  EXPECT_EQ(count.note({5, 1, 0}, kFirst), FrameOrder::kNext);
  EXPECT_NE(count.note({5, 1, 0}, kLast), FrameOrder::kDuplicate);
}

TEST(DuplicateFilter, AreTheSameBytesOfTheSameFrameSoonAfter) {
  DuplicateFilter repeats;
  const std::vector<std::uint8_t> a = {1, 2, 3};
  const std::vector<std::uint8_t> b = {1, 2, 4};
  const DuplicateFilter::Clock::time_point start{};
  const auto soon = start + std::chrono::microseconds(10);
  EXPECT_FALSE(repeats.is_duplicate({"LEFT", 1}, a.data(), a.size(), start));
  EXPECT_TRUE(repeats.is_duplicate({"LEFT", 1}, a.data(), a.size(), soon));
  EXPECT_FALSE(repeats.is_duplicate({"LEFT", 1}, b.data(), b.size(), soon)) << "of another detector";
  EXPECT_FALSE(repeats.is_duplicate({"RIGHT", 1}, a.data(), a.size(), soon));
  EXPECT_FALSE(repeats.is_duplicate({"LEFT", 1}, a.data(), a.size(), start + std::chrono::seconds(2)))
      << "a log that is replayed";
}

}  // namespace
}  // namespace houghstream
