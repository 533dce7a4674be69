#include <gtest/gtest.h>

#include <limits>

#include "pipeline/base/checks.hpp"
#include "pose/tracks/tracker.hpp"

namespace houghstream::tracks {
namespace {

constexpr std::int64_t kSecondUs = 1000000;

/// Returns the order of a frame that came last.
TimeOrder classify_at(WorldClock& clock, const FrameId& frame, const FrameNumber& number = {}) {
  const TimeOrder order = clock.classify({frame, number, frame.utime});
  if (order == TimeOrder::kReset) clock.reset();
  if (order != TimeOrder::kLate) clock.set({frame, number, frame.utime});
  return order;
}

/// A camera at 30 Hz whose frames have numbers.
struct Source {
  std::string channel = "LEFT";
  std::int64_t utime = 100 * kSecondUs;
  std::int64_t number = 0;
  std::int64_t run = 7;

  FrameNumber next() {
    utime += 33333;
    return {number++, utime, run};
  }
  TimeOrder classify_frame(WorldClock& clock) {
    const FrameNumber frame = next();
    return classify_at(clock, {channel, utime}, frame);
  }
};

TEST(WorldClock, TimeGoesBackWhereACamerasFramesDo) {
  WorldClock clock;
  EXPECT_EQ(classify_at(clock, {"LEFT", 100 * kSecondUs}), TimeOrder::kNext);
  EXPECT_EQ(classify_at(clock, {"RIGHT", 100 * kSecondUs}), TimeOrder::kNext);
  EXPECT_EQ(classify_at(clock, {"LEFT", 100 * kSecondUs - 50000}), TimeOrder::kLate);
  EXPECT_EQ(clock.classify({{"LEFT", 90 * kSecondUs}, {}, 100 * kSecondUs}), TimeOrder::kLate)
      << "its result took long";
  EXPECT_EQ(classify_at(clock, {"LEFT", 10 * kSecondUs}), TimeOrder::kLate) << "one stamp may be wrong";
  EXPECT_EQ(classify_at(clock, {"LEFT", 10 * kSecondUs}), TimeOrder::kLate) << "another result of the same frame";
  EXPECT_EQ(classify_at(clock, {"LEFT", 10 * kSecondUs + 33333}), TimeOrder::kReset);
  EXPECT_EQ(classify_at(clock, {"RIGHT", 10 * kSecondUs}), TimeOrder::kNext) << "of the same new world";
  EXPECT_EQ(clock.classify({{"LEFT", 100 * kSecondUs}, {}, 10 * kSecondUs}), TimeOrder::kLate) << "of the earlier run";
}

TEST(WorldClock, ALogOrSourceThatBeginsAgainIsANewWorldAtOnce) {
  WorldClock clock;
  for (const std::int64_t other_run : {0, 1}) {
    Source source;
    for (int i = 0; i < 90; ++i) source.classify_frame(clock);
    Source again;
    again.run += other_run;
    EXPECT_EQ(again.classify_frame(clock), TimeOrder::kReset) << other_run;
    EXPECT_EQ(again.classify_frame(clock), TimeOrder::kNext);
  }
}

TEST(WorldClock, AShortSourceThatIsStartedAgainWithTheSameStampsIsANewWorld) {
  WorldClock clock;
  for (int run = 1; run <= 3; ++run) {
    Source source;
    source.run = run;
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(source.classify_frame(clock), run > 1 && i == 0 ? TimeOrder::kReset : TimeOrder::kNext)
          << run << " " << i;
  }
}

TEST(WorldClock, AClockThatIsSetLeavesTheWorldGoingOn) {
  constexpr std::int64_t kHour = 3600 * kSecondUs;
  for (const std::int64_t step : {-kHour, kHour, -1500000L, 1500000L, 8760 * kHour}) {
    WorldClock clock;
    Source left;
    Source right{"RIGHT"};
    std::int64_t last = left.utime;
    for (int i = 0; i < 90; ++i) {
      if (i == 30) left.utime += step;
      if (i == 30) right.utime += step;
      const TimeOrder of_left = left.classify_frame(clock);
      const TimeOrder of_right = right.classify_frame(clock);
      EXPECT_EQ(of_left, i == 30 ? TimeOrder::kLate : TimeOrder::kNext) << step << " " << i;
      EXPECT_EQ(of_right, i == 30 ? TimeOrder::kLate : TimeOrder::kNext) << step << " " << i;
      const std::int64_t now = left.utime + clock.offset_us();
      if (i != 30) {
        EXPECT_GT(now, last);
        EXPECT_LE(now, last + 61 * kSecondUs) << "nothing waits for an hour";
        last = now;
      }
    }
  }
}

TEST(WorldClock, OneWrongStampIsPassedOver) {
  constexpr std::int64_t kYear = 8760 * 3600 * kSecondUs;
  for (const std::int64_t wrong : {kYear, -kYear, 5 * kSecondUs, -5 * kSecondUs}) {
    for (const bool with_numbers : {true, false}) {
      WorldClock clock;
      Source source;
      for (int i = 0; i < 30; ++i) {
        const FrameNumber number = with_numbers ? source.next() : FrameNumber{{}, source.next().utime, 0};
        const bool is_wrong = i == 10 || i == 12;
        const TimeOrder order = classify_at(clock, {"LEFT", source.utime + (is_wrong ? wrong : 0)}, number);
        EXPECT_EQ(order, is_wrong ? TimeOrder::kLate : TimeOrder::kNext) << wrong << " " << i;
      }
      EXPECT_EQ(clock.offset_us(), 0);
    }
  }
}

TEST(WorldClock, TheFirstFrameOfAnotherCameraMayHaveAWrongStamp) {
  WorldClock clock;
  Source left;
  Source right{"RIGHT"};
  for (int i = 0; i < 10; ++i) EXPECT_EQ(left.classify_frame(clock), TimeOrder::kNext);
  EXPECT_EQ(classify_at(clock, {"RIGHT", left.utime + 1000 * kSecondUs}), TimeOrder::kLate);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(left.classify_frame(clock), TimeOrder::kNext);
  right.utime = left.utime;
  EXPECT_EQ(right.classify_frame(clock), TimeOrder::kNext);
}

TEST(WorldClock, ResultsMayComeSeldom) {
  WorldClock clock;
  int late = 0;
  for (std::int64_t second = 100; second < 160; second += 2)
    late += classify_at(clock, {"LEFT", second * kSecondUs}) == TimeOrder::kLate ? 1 : 0;
  EXPECT_EQ(late, 1) << "as long as nobody knows how seldom";
}

TEST(WorldClock, TimesMayBeAny) {
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  WorldClock clock;
  for (const std::int64_t utime : {kFirst, kLast, kLast - 1, kFirst, kFirst + 1, std::int64_t{0}, kLast, kFirst})
    classify_at(clock, {"LEFT", utime}, {utime / 2, utime, 1});
  Source source;
  for (int i = 0; i < 3; ++i) source.classify_frame(clock);
  EXPECT_EQ(source.classify_frame(clock), TimeOrder::kNext);
}

TEST(WorldClock, ACameraThatIsBehindIsRefusedAsLongAsTheOtherGoesOn) {
  WorldClock clock;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(classify_at(clock, {"AHEAD", 100 * kSecondUs + 33333 * i}), TimeOrder::kNext);
    EXPECT_THROW(classify_at(clock, {"BEHIND", 50 * kSecondUs + 33333 * i}), InputError) << i;
  }
  for (int i = 1; i < 29; ++i)
    EXPECT_THROW(classify_at(clock, {"BEHIND", 60 * kSecondUs + 33333 * i}), InputError) << i;
  EXPECT_EQ(classify_at(clock, {"BEHIND", 62 * kSecondUs}), TimeOrder::kReset) << "the other is no more";
  EXPECT_EQ(classify_at(clock, {"BEHIND", 62 * kSecondUs + 33333}), TimeOrder::kNext);
}

StampedFrame frame_at(const std::string& channel, std::int64_t utime) {
  return {{channel, utime}, {}, utime};
}

TEST(WorldClock, SecondsAreThoseBetweenACamerasFramesAsFarAsTheyCount) {
  WorldClock clock;
  EXPECT_NEAR(clock.set(frame_at("LEFT", 0)).dt_s, 1.0 / 30.0, 1e-12);
  EXPECT_NEAR(clock.set(frame_at("RIGHT", 20000)).dt_s, 1.0 / 30.0, 1e-12);
  EXPECT_NEAR(clock.set(frame_at("LEFT", 50000)).dt_s, 0.05, 1e-12);
  EXPECT_EQ(clock.set(frame_at("LEFT", 50000)).results, 2);
  EXPECT_NEAR(clock.set(frame_at("LEFT", 5 * kSecondUs)).dt_s, 0.1, 1e-12);
}

}  // namespace
}  // namespace houghstream::tracks
