#include "pipeline/process/frame_synchroniser.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

constexpr std::chrono::milliseconds kNow(0);

std::vector<std::uint8_t> bytes(int value) {
  return {static_cast<std::uint8_t>(value)};
}

SharedBytes arrived_bytes(int value) {
  return std::make_shared<const std::vector<std::uint8_t>>(bytes(value));
}

FrameId id(std::int64_t utime) {
  return {"LEFT", utime};
}

TEST(FrameSynchroniser, PairsWhicheverComesFirst) {
  FrameSynchroniser synchroniser(true);
  synchroniser.add_frame(id(1), arrived_bytes(11));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  synchroniser.add_result(id(1), bytes(21));
  std::optional<SynchronisedMessages> pair = synchroniser.pop(kNow);
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(*pair->frame, bytes(11));
  EXPECT_EQ(pair->result, bytes(21));

  synchroniser.add_result(id(2), bytes(22));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  synchroniser.add_frame(id(2), arrived_bytes(12));
  pair = synchroniser.pop(kNow);
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(*pair->frame, bytes(12));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
}

TEST(FrameSynchroniser, NeverPairsAnotherFrame) {
  FrameSynchroniser synchroniser(true);
  synchroniser.add_frame(id(1), arrived_bytes(11));
  synchroniser.add_frame(id(3), arrived_bytes(13));
  synchroniser.add_result(id(2), bytes(22));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
}

TEST(FrameSynchroniser, NewestFirstPassesOverOlderOnes) {
  FrameSynchroniser synchroniser(true);
  for (int i = 1; i <= 3; ++i) {
    synchroniser.add_frame(id(i), arrived_bytes(10 + i));
    synchroniser.add_result(id(i), bytes(20 + i));
  }
  EXPECT_EQ(synchroniser.pop(kNow)->result, bytes(23));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  EXPECT_EQ(synchroniser.pop_dropped().skipped, 2);
  EXPECT_EQ(synchroniser.pop_dropped().skipped, 0);
}

TEST(FrameSynchroniser, TheNewestFrameMayBeTakenAheadOnce) {
  FrameSynchroniser synchroniser(true);
  EXPECT_FALSE(synchroniser.pop_unmatched_frame().has_value());
  synchroniser.add_frame(id(1), arrived_bytes(11));
  synchroniser.add_frame(id(2), arrived_bytes(12));
  EXPECT_FALSE(synchroniser.pop(std::chrono::minutes(1)).has_value()) << "does not wait: a frame has come";
  const std::optional<StoredFrame> fresh = synchroniser.pop_unmatched_frame();
  ASSERT_TRUE(fresh.has_value());
  EXPECT_EQ(fresh->id, id(2));
  EXPECT_EQ(*fresh->bytes, bytes(12));
  EXPECT_FALSE(synchroniser.pop_unmatched_frame().has_value());
  synchroniser.add_result(id(2), bytes(22));
  EXPECT_EQ(*synchroniser.pop(kNow)->frame, bytes(12)) << "it stays for its detections";

  synchroniser.add_frame(id(3), arrived_bytes(13));
  synchroniser.add_result(id(3), bytes(23));
  EXPECT_TRUE(synchroniser.pop(kNow).has_value());
  EXPECT_FALSE(synchroniser.pop_unmatched_frame().has_value()) << "its pair has been taken";
}

TEST(FrameSynchroniser, WhoTakesNothingAheadWaitsForPairsOnly) {
  FrameSynchroniser synchroniser(true, false);
  synchroniser.add_frame(id(1), arrived_bytes(11));
  EXPECT_FALSE(synchroniser.pop_unmatched_frame().has_value());
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  synchroniser.add_result(id(1), bytes(21));
  EXPECT_EQ(*synchroniser.pop(kNow)->frame, bytes(11));
}

/// A gate that says the same of each pair until it is told otherwise, by a clock that the test sets.
struct TestGate {
  FrameGate::Decision decision{FrameGate::Answer::kWait, ""};
  std::int64_t now_us = 0;
  std::vector<double> ages_s;

  FrameGate gate() {
    FrameGate made;
    made.decide = [this](const FrameId&, double age_s) {
      ages_s.push_back(age_s);
      return decision;
    };
    made.now_us = [this] { return now_us; };
    made.awaited = "the key";
    return made;
  }
};

void add_pair(FrameSynchroniser& synchroniser, std::int64_t utime, const SharedBytes& frame) {
  synchroniser.add_frame(id(utime), frame);
  synchroniser.add_result(id(utime), bytes(static_cast<int>(utime)));
}

TEST(FrameSynchroniser, APairWaitsForTheGateWithItsFrameHoweverManyFramesCome) {
  TestGate test;
  FrameSynchroniser synchroniser(false, false, test.gate());
  add_pair(synchroniser, 1, arrived_bytes(11));
  EXPECT_FALSE(synchroniser.pop(std::chrono::minutes(1)).has_value()) << "returns at once: its age will pass";
  for (int i = 0; i <= static_cast<int>(FrameSynchroniser::kCachedFrames); ++i)
    synchroniser.add_frame(id(100 + i), arrived_bytes(0));
  test.now_us = 250000;
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  EXPECT_EQ(test.ages_s.front(), 0.0);
  EXPECT_EQ(test.ages_s.back(), 0.25);
  add_pair(synchroniser, 2, arrived_bytes(12));
  test.decision.answer = FrameGate::Answer::kAccept;
  synchroniser.recheck_gate();
  EXPECT_EQ(*synchroniser.pop(kNow)->frame, bytes(11)) << "the oldest first";
  EXPECT_EQ(*synchroniser.pop(kNow)->frame, bytes(12));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  EXPECT_TRUE(synchroniser.pop_dropped().refused.empty());
}

TEST(FrameSynchroniser, WhatTheGateRefusesIsToldWithItsReasonAndWhatStillWaitsInTheEnd) {
  TestGate test;
  FrameSynchroniser synchroniser(false, false, test.gate());
  add_pair(synchroniser, 1, arrived_bytes(11));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  test.decision = {FrameGate::Answer::kRefuse, "no key"};
  add_pair(synchroniser, 2, arrived_bytes(12));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  test.decision = {FrameGate::Answer::kWait, ""};
  add_pair(synchroniser, 3, arrived_bytes(13));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  synchroniser.flush();
  const std::vector<FrameSynchroniser::Refused> refused = synchroniser.pop_dropped().refused;
  ASSERT_EQ(refused.size(), 3U);
  for (std::size_t i = 0; i < refused.size(); ++i) {
    EXPECT_EQ(refused[i].id, id(static_cast<std::int64_t>(i) + 1));
    EXPECT_EQ(refused[i].reason, i < 2 ? "no key" : "the stream has ended");
  }
}

TEST(FrameSynchroniser, PairsThatWaitForTheGateAreKeptWithinBounds) {
  constexpr std::int64_t kMore = 5;
  for (const bool large : {false, true}) {
    TestGate test;
    FrameSynchroniser synchroniser(false, false, test.gate());
    constexpr std::int64_t kLargeKept = 4;
    const std::int64_t kept = large ? kLargeKept : static_cast<std::int64_t>(FrameSynchroniser::kMaxDeferred);
    for (std::int64_t i = 1; i <= kept + kMore; ++i) {
      add_pair(synchroniser, i,
               std::make_shared<const std::vector<std::uint8_t>>(
                   large ? FrameSynchroniser::kMaxDeferredBytes / static_cast<std::size_t>(kLargeKept) : 1));
      EXPECT_FALSE(synchroniser.pop(kNow).has_value());
    }
    const std::vector<FrameSynchroniser::Refused> refused = synchroniser.pop_dropped().refused;
    ASSERT_EQ(static_cast<std::int64_t>(refused.size()), kMore);
    EXPECT_EQ(refused[0].id, id(1));
    EXPECT_EQ(refused[0].reason, "too many wait for the key");
    test.decision.answer = FrameGate::Answer::kAccept;
    EXPECT_EQ(synchroniser.pop(kNow)->id, id(kMore + 1));
  }
}

TEST(FrameSynchroniser, ALogIsWorkedOnInTurn) {
  FrameSynchroniser synchroniser(false);
  for (int i = 1; i <= 3; ++i) {
    synchroniser.add_frame(id(i), arrived_bytes(10 + i));
    synchroniser.add_result(id(i), bytes(20 + i));
  }
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(synchroniser.pop(kNow)->result, bytes(20 + i));
  EXPECT_EQ(synchroniser.pop_dropped().skipped, 0);
}

TEST(FrameSynchroniser, DetectionsWithoutAFrameAreGivenUpInTheEnd) {
  FrameSynchroniser synchroniser(true);
  synchroniser.add_result(id(-5), bytes(1));
  for (int i = 0; i < FrameSynchroniser::kMaxLagFrames; ++i) synchroniser.add_frame(id(i), arrived_bytes(i));
  EXPECT_TRUE(synchroniser.pop_dropped().without_frame.empty());
  synchroniser.add_frame(id(100), arrived_bytes(0));
  EXPECT_EQ(synchroniser.pop_dropped().without_frame, std::vector<FrameId>{id(-5)});

  synchroniser.add_result(id(200), bytes(2));
  synchroniser.flush();
  EXPECT_EQ(synchroniser.pop_dropped().without_frame, std::vector<FrameId>{id(200)});
}

TEST(FrameSynchroniser, MemoryIsBoundedWhereFramesNeverCome) {
  FrameSynchroniser synchroniser(true);
  const int count = 500;
  for (int i = 0; i < count; ++i) synchroniser.add_result(id(i), bytes(0));
  EXPECT_EQ(synchroniser.pop_dropped().without_frame.size(), count - FrameSynchroniser::kCachedFrames);
}

TEST(FrameSynchroniser, MemoryIsBoundedWhereResultsOfOneFrameComeWithoutEnd) {
  for (const bool newest_first : {true, false}) {
    FrameSynchroniser synchroniser(newest_first);
    synchroniser.add_frame(id(1), arrived_bytes(11));
    const int count = 500;
    for (int i = 0; i < count; ++i) synchroniser.add_result(id(1), {1, static_cast<std::uint8_t>(i)});
    std::size_t taken = 0;
    while (synchroniser.pop(kNow)) ++taken;
    EXPECT_EQ(taken, FrameSynchroniser::kMaxPending);
    const FrameSynchroniser::Dropped dropped = synchroniser.pop_dropped();
    EXPECT_EQ(dropped.skipped, count - static_cast<std::int64_t>(FrameSynchroniser::kMaxPending));
    EXPECT_TRUE(dropped.without_frame.empty());
  }
}

TEST(FrameSynchroniser, TwoCamerasOfEqualTimesKeepTheirFramesApart) {
  for (const bool newest_first : {true, false}) {
    FrameSynchroniser synchroniser(newest_first);
    synchroniser.add_frame({"LEFT", 1}, arrived_bytes(11));
    synchroniser.add_frame({"RIGHT", 1}, arrived_bytes(12));
    synchroniser.add_result({"RIGHT", 1}, bytes(22));
    synchroniser.add_result({"LEFT", 1}, bytes(21));
    for (int i = 0; i < 2; ++i) {
      const std::optional<SynchronisedMessages> pair = synchroniser.pop(kNow);
      ASSERT_TRUE(pair.has_value());
      const int camera = pair->id.channel == "LEFT" ? 1 : 2;
      EXPECT_EQ(*pair->frame, bytes(10 + camera));
      EXPECT_EQ(pair->result, bytes(20 + camera));
    }
    EXPECT_EQ(synchroniser.pop_dropped().skipped, 0);
  }
}

TEST(FrameSynchroniser, AFastCameraDoesNotStarveASlowOne) {
  FrameSynchroniser synchroniser(true);
  int slow = 0;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 5; ++k) {
      synchroniser.add_frame({"FAST", 5 * i + k}, arrived_bytes(0));
      synchroniser.add_result({"FAST", 5 * i + k}, bytes(0));
    }
    synchroniser.add_frame({"SLOW", i}, arrived_bytes(0));
    synchroniser.add_result({"SLOW", i}, bytes(0));
    slow += synchroniser.pop(kNow)->id.channel == "SLOW" ? 1 : 0;
  }
  EXPECT_EQ(slow, 10) << "each has its turn";
}

TEST(FrameSynchroniser, OfTwoDetectorsEachKeepsItsNewestResult) {
  FrameSynchroniser synchroniser(true);
  for (int i = 1; i <= 3; ++i) {
    synchroniser.add_frame(id(i), arrived_bytes(10 + i));
    synchroniser.add_result(id(i), bytes(20 + i));
    synchroniser.add_result(id(i), bytes(30 + i));
  }
  EXPECT_EQ(synchroniser.pop(kNow)->result, bytes(23));
  EXPECT_EQ(synchroniser.pop(kNow)->result, bytes(33));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  EXPECT_EQ(synchroniser.pop_dropped().skipped, 4);
}

TEST(FrameSynchroniser, OtherCamerasFramesDoNotAgeWhatWaits) {
  FrameSynchroniser synchroniser(true);
  synchroniser.add_result({"LEFT", 7}, bytes(1));
  for (int i = 0; i < 5 * FrameSynchroniser::kMaxLagFrames; ++i) synchroniser.add_frame({"RIGHT", i}, arrived_bytes(0));
  EXPECT_TRUE(synchroniser.pop_dropped().without_frame.empty());
  synchroniser.add_frame({"LEFT", 7}, arrived_bytes(2));
  EXPECT_TRUE(synchroniser.pop(kNow).has_value());
}

TEST(FrameSynchroniser, OldFramesAreForgotten) {
  FrameSynchroniser synchroniser(true);
  for (int i = 0; i <= static_cast<int>(FrameSynchroniser::kCachedFrames); ++i)
    synchroniser.add_frame(id(i), arrived_bytes(0));
  synchroniser.add_result(id(0), bytes(0));
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  synchroniser.add_result(id(1), bytes(0));
  EXPECT_TRUE(synchroniser.pop(kNow).has_value());
}

TEST(FrameSynchroniser, LargeFramesAreKeptWithinABoundInBytes) {
  FrameSynchroniser synchroniser(true);
  const auto large = std::make_shared<const std::vector<std::uint8_t>>(FrameSynchroniser::kCachedBytes / 8);
  for (int i = 0; i < 20; ++i) synchroniser.add_frame({"LEFT", i}, large);
  synchroniser.add_frame({"RIGHT", 1}, large);
  synchroniser.add_result({"LEFT", 19}, {});
  EXPECT_TRUE(synchroniser.pop(kNow).has_value());
  synchroniser.add_result({"RIGHT", 1}, {});
  EXPECT_TRUE(synchroniser.pop(kNow).has_value());
  synchroniser.add_result({"LEFT", 5}, {});
  EXPECT_FALSE(synchroniser.pop(kNow).has_value()) << "the oldest ones are gone";
}

TEST(FrameSynchroniser, LargeFramesOfManyCamerasAreKeptWithinTheBoundToo) {
  FrameSynchroniser synchroniser(true);
  const auto large = std::make_shared<const std::vector<std::uint8_t>>(FrameSynchroniser::kCachedBytes / 3);
  const auto kept = [&] { return static_cast<std::size_t>(large.use_count() - 1) * large->size(); };
  for (std::size_t i = 0; i < FrameSynchroniser::kCameras; ++i) {
    synchroniser.add_frame({std::to_string(i), 1}, large);
    EXPECT_LE(kept(), FrameSynchroniser::kCachedBytes);
  }
  EXPECT_EQ(kept(), 3 * large->size());
  synchroniser.add_result({"63", 1}, {});
  EXPECT_TRUE(synchroniser.pop(kNow).has_value()) << "the newest ones stay";
  synchroniser.add_result({"0", 1}, {});
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
  std::size_t fresh = 0;
  while (synchroniser.pop_unmatched_frame()) ++fresh;
  EXPECT_EQ(fresh, 2U) << "what is gone is not taken ahead";
}

TEST(FrameSynchroniser, TheLastFrameStaysHoweverLargeItIs) {
  FrameSynchroniser synchroniser(true);
  const auto large = std::make_shared<const std::vector<std::uint8_t>>(FrameSynchroniser::kCachedBytes + 1);
  synchroniser.add_frame({"LEFT", 1}, arrived_bytes(1));
  synchroniser.add_frame({"RIGHT", 1}, large);
  synchroniser.add_result({"RIGHT", 1}, {});
  EXPECT_TRUE(synchroniser.pop(kNow).has_value());
  synchroniser.add_result({"LEFT", 1}, {});
  EXPECT_FALSE(synchroniser.pop(kNow).has_value());
}

TEST(FrameSynchroniser, ListensToAFewCamerasOnly) {
  FrameSynchroniser synchroniser(true);
  for (std::size_t i = 0; i < FrameSynchroniser::kCameras; ++i)
    synchroniser.add_frame({std::to_string(i), 1}, arrived_bytes(1));
  EXPECT_THROW(synchroniser.add_frame({"one more", 1}, arrived_bytes(1)), InputError);
  EXPECT_THROW(synchroniser.add_result({"one more", 1}, {1}), InputError);
  EXPECT_NO_THROW(synchroniser.add_frame({"0", 2}, arrived_bytes(1)));
}

TEST(FrameSynchroniser, LargeDetectionsOfManyCamerasAreKeptWithinABound) {
  FrameSynchroniser synchroniser(false);
  constexpr int kCameras = 3;
  for (int i = 0; i < 60; ++i) {
    for (int camera = 0; camera < kCameras; ++camera)
      synchroniser.add_result({std::to_string(camera), i}, std::vector<std::uint8_t>(Reception::kMaxResultBytes));
  }
  constexpr std::size_t kMax = FrameSynchroniser::kMaxPendingBytes / Reception::kMaxResultBytes;
  EXPECT_EQ(synchroniser.pop_dropped().without_frame.size(), kCameras * 60 - kMax);
  for (int camera = 0; camera < kCameras; ++camera)
    synchroniser.add_frame({std::to_string(camera), 59}, arrived_bytes(1));
  for (int camera = 0; camera < kCameras; ++camera) EXPECT_TRUE(synchroniser.pop(kNow).has_value());
}

}  // namespace
}  // namespace houghstream
