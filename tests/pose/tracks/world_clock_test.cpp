#include "pose/tracks/world_clock.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream::tracks {
namespace {

constexpr std::int64_t kSecondUs = 1000000;

/// Told of a frame that came last.
TimeOrder tell(WorldClock& clock, const FrameId& frame) {
  const TimeOrder order = clock.order_of(frame, frame.utime);
  if (order == TimeOrder::kAnew) clock.begin_world();
  if (order != TimeOrder::kLate) clock.set(frame);
  return order;
}

TEST(WorldClock, TimeGoesBackWhereACamerasFramesDo) {
  WorldClock clock;
  EXPECT_EQ(tell(clock, {"LEFT", 100 * kSecondUs}), TimeOrder::kNext);
  EXPECT_EQ(tell(clock, {"RIGHT", 100 * kSecondUs}), TimeOrder::kNext);
  EXPECT_EQ(tell(clock, {"LEFT", 100 * kSecondUs - 50000}), TimeOrder::kLate);
  EXPECT_EQ(clock.order_of({"LEFT", 90 * kSecondUs}, 100 * kSecondUs), TimeOrder::kLate) << "its result took long";
  EXPECT_EQ(tell(clock, {"LEFT", 10 * kSecondUs}), TimeOrder::kAnew);
  EXPECT_EQ(tell(clock, {"RIGHT", 10 * kSecondUs}), TimeOrder::kNext) << "of the same new world";
  EXPECT_EQ(clock.order_of({"LEFT", 100 * kSecondUs}, 10 * kSecondUs), TimeOrder::kLate) << "of the earlier run";
}

TEST(WorldClock, ACameraThatIsBehindIsRefusedAsLongAsTheOtherGoesOn) {
  WorldClock clock;
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(tell(clock, {"AHEAD", 100 * kSecondUs + 33333 * i}), TimeOrder::kNext);
    EXPECT_THROW(tell(clock, {"BEHIND", 50 * kSecondUs + 33333 * i}), InputError) << i;
  }
  for (int i = 1; i < 29; ++i) EXPECT_THROW(tell(clock, {"BEHIND", 60 * kSecondUs + 33333 * i}), InputError) << i;
  EXPECT_EQ(tell(clock, {"BEHIND", 62 * kSecondUs}), TimeOrder::kAnew) << "the other is no more";
  EXPECT_EQ(tell(clock, {"BEHIND", 62 * kSecondUs + 33333}), TimeOrder::kNext);
}

TEST(WorldClock, SecondsAreThoseBetweenACamerasFramesAsFarAsTheyCount) {
  WorldClock clock;
  EXPECT_NEAR(clock.set({"LEFT", 0}).seconds, 1.0 / 30.0, 1e-12);
  EXPECT_NEAR(clock.set({"RIGHT", 20000}).seconds, 1.0 / 30.0, 1e-12);
  EXPECT_NEAR(clock.set({"LEFT", 50000}).seconds, 0.05, 1e-12);
  EXPECT_EQ(clock.set({"LEFT", 50000}).results, 2);
  EXPECT_NEAR(clock.set({"LEFT", 5 * kSecondUs}).seconds, 0.1, 1e-12);
}

}  // namespace
}  // namespace houghstream::tracks
