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
  FrameSynchroniser inbox(true);
  inbox.add_frame(id(1), arrived_bytes(11));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  inbox.add_detections(id(1), bytes(21));
  std::optional<SynchronisedMessages> pair = inbox.pop(kNow);
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(*pair->frame, bytes(11));
  EXPECT_EQ(pair->detections, bytes(21));

  inbox.add_detections(id(2), bytes(22));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  inbox.add_frame(id(2), arrived_bytes(12));
  pair = inbox.pop(kNow);
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(*pair->frame, bytes(12));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
}

TEST(FrameSynchroniser, NeverPairsAnotherFrame) {
  FrameSynchroniser inbox(true);
  inbox.add_frame(id(1), arrived_bytes(11));
  inbox.add_frame(id(3), arrived_bytes(13));
  inbox.add_detections(id(2), bytes(22));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
}

TEST(FrameSynchroniser, NewestFirstPassesOverOlderOnes) {
  FrameSynchroniser inbox(true);
  for (int i = 1; i <= 3; ++i) {
    inbox.add_frame(id(i), arrived_bytes(10 + i));
    inbox.add_detections(id(i), bytes(20 + i));
  }
  EXPECT_EQ(inbox.pop(kNow)->detections, bytes(23));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  EXPECT_EQ(inbox.pop_dropped().skipped, 2);
  EXPECT_EQ(inbox.pop_dropped().skipped, 0);
}

TEST(FrameSynchroniser, TheNewestFrameMayBeTakenAheadOnce) {
  FrameSynchroniser inbox(true);
  EXPECT_FALSE(inbox.pop_unmatched_frame().has_value());
  inbox.add_frame(id(1), arrived_bytes(11));
  inbox.add_frame(id(2), arrived_bytes(12));
  EXPECT_FALSE(inbox.pop(std::chrono::minutes(1)).has_value()) << "does not wait: a frame has come";
  const std::optional<ArrivedFrame> fresh = inbox.pop_unmatched_frame();
  ASSERT_TRUE(fresh.has_value());
  EXPECT_EQ(fresh->id, id(2));
  EXPECT_EQ(*fresh->bytes, bytes(12));
  EXPECT_FALSE(inbox.pop_unmatched_frame().has_value());
  inbox.add_detections(id(2), bytes(22));
  EXPECT_EQ(*inbox.pop(kNow)->frame, bytes(12)) << "it stays for its detections";

  inbox.add_frame(id(3), arrived_bytes(13));
  inbox.add_detections(id(3), bytes(23));
  EXPECT_TRUE(inbox.pop(kNow).has_value());
  EXPECT_FALSE(inbox.pop_unmatched_frame().has_value()) << "its pair has been taken";
}

TEST(FrameSynchroniser, WhoTakesNothingAheadWaitsForPairsOnly) {
  FrameSynchroniser inbox(true, false);
  inbox.add_frame(id(1), arrived_bytes(11));
  EXPECT_FALSE(inbox.pop_unmatched_frame().has_value());
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  inbox.add_detections(id(1), bytes(21));
  EXPECT_EQ(*inbox.pop(kNow)->frame, bytes(11));
}

/// A gate that says the same of each pair until it is told otherwise, by a clock that the test sets.
struct TestGate {
  FrameGate::Decision decision{FrameGate::Answer::kWait, ""};
  std::int64_t now_us = 0;
  std::vector<double> ages_s;

  FrameGate gate() {
    FrameGate made;
    made.ask = [this](const FrameId&, double age_s) {
      ages_s.push_back(age_s);
      return decision;
    };
    made.now_us = [this] { return now_us; };
    made.awaited = "the key";
    return made;
  }
};

void add_pair(FrameSynchroniser& inbox, std::int64_t utime, const SharedBytes& frame) {
  inbox.add_frame(id(utime), frame);
  inbox.add_detections(id(utime), bytes(static_cast<int>(utime)));
}

TEST(FrameSynchroniser, APairWaitsForTheGateWithItsFrameHoweverManyFramesCome) {
  TestGate test;
  FrameSynchroniser inbox(false, false, test.gate());
  add_pair(inbox, 1, arrived_bytes(11));
  EXPECT_FALSE(inbox.pop(std::chrono::minutes(1)).has_value()) << "returns at once: its age will pass";
  for (int i = 0; i <= static_cast<int>(FrameSynchroniser::kHistory); ++i)
    inbox.add_frame(id(100 + i), arrived_bytes(0));
  test.now_us = 250000;
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  EXPECT_EQ(test.ages_s.front(), 0.0);
  EXPECT_EQ(test.ages_s.back(), 0.25);
  add_pair(inbox, 2, arrived_bytes(12));
  test.decision.answer = FrameGate::Answer::kGo;
  inbox.recheck_gate();
  EXPECT_EQ(*inbox.pop(kNow)->frame, bytes(11)) << "the oldest first";
  EXPECT_EQ(*inbox.pop(kNow)->frame, bytes(12));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  EXPECT_TRUE(inbox.pop_dropped().refused.empty());
}

TEST(FrameSynchroniser, WhatTheGateRefusesIsToldWithItsReasonAndWhatStillWaitsInTheEnd) {
  TestGate test;
  FrameSynchroniser inbox(false, false, test.gate());
  add_pair(inbox, 1, arrived_bytes(11));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  test.decision = {FrameGate::Answer::kRefuse, "no key"};
  add_pair(inbox, 2, arrived_bytes(12));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  test.decision = {FrameGate::Answer::kWait, ""};
  add_pair(inbox, 3, arrived_bytes(13));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  inbox.flush();
  const std::vector<FrameSynchroniser::Refused> refused = inbox.pop_dropped().refused;
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
    FrameSynchroniser inbox(false, false, test.gate());
    constexpr std::int64_t kLargeKept = 4;
    const std::int64_t kept = large ? kLargeKept : static_cast<std::int64_t>(FrameSynchroniser::kHeldBack);
    for (std::int64_t i = 1; i <= kept + kMore; ++i) {
      add_pair(inbox, i,
               std::make_shared<const std::vector<std::uint8_t>>(
                   large ? FrameSynchroniser::kHeldBackBytes / static_cast<std::size_t>(kLargeKept) : 1));
      EXPECT_FALSE(inbox.pop(kNow).has_value());
    }
    const std::vector<FrameSynchroniser::Refused> refused = inbox.pop_dropped().refused;
    ASSERT_EQ(static_cast<std::int64_t>(refused.size()), kMore);
    EXPECT_EQ(refused[0].id, id(1));
    EXPECT_EQ(refused[0].reason, "too many wait for the key");
    test.decision.answer = FrameGate::Answer::kGo;
    EXPECT_EQ(inbox.pop(kNow)->id, id(kMore + 1));
  }
}

TEST(FrameSynchroniser, ALogIsWorkedOnInTurn) {
  FrameSynchroniser inbox(false);
  for (int i = 1; i <= 3; ++i) {
    inbox.add_frame(id(i), arrived_bytes(10 + i));
    inbox.add_detections(id(i), bytes(20 + i));
  }
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(inbox.pop(kNow)->detections, bytes(20 + i));
  EXPECT_EQ(inbox.pop_dropped().skipped, 0);
}

TEST(FrameSynchroniser, DetectionsWithoutAFrameAreGivenUpInTheEnd) {
  FrameSynchroniser inbox(true);
  inbox.add_detections(id(-5), bytes(1));
  for (int i = 0; i < FrameSynchroniser::kMaxLagFrames; ++i) inbox.add_frame(id(i), arrived_bytes(i));
  EXPECT_TRUE(inbox.pop_dropped().without_frame.empty());
  inbox.add_frame(id(100), arrived_bytes(0));
  EXPECT_EQ(inbox.pop_dropped().without_frame, std::vector<FrameId>{id(-5)});

  inbox.add_detections(id(200), bytes(2));
  inbox.flush();
  EXPECT_EQ(inbox.pop_dropped().without_frame, std::vector<FrameId>{id(200)});
}

TEST(FrameSynchroniser, MemoryIsBoundedWhereFramesNeverCome) {
  FrameSynchroniser inbox(true);
  const int count = 500;
  for (int i = 0; i < count; ++i) inbox.add_detections(id(i), bytes(0));
  EXPECT_EQ(inbox.pop_dropped().without_frame.size(), count - FrameSynchroniser::kHistory);
}

TEST(FrameSynchroniser, MemoryIsBoundedWhereResultsOfOneFrameComeWithoutEnd) {
  for (const bool newest_first : {true, false}) {
    FrameSynchroniser inbox(newest_first);
    inbox.add_frame(id(1), arrived_bytes(11));
    const int count = 500;
    for (int i = 0; i < count; ++i) inbox.add_detections(id(1), {1, static_cast<std::uint8_t>(i)});
    std::size_t taken = 0;
    while (inbox.pop(kNow)) ++taken;
    EXPECT_EQ(taken, FrameSynchroniser::kWaiting);
    const FrameSynchroniser::Dropped dropped = inbox.pop_dropped();
    EXPECT_EQ(dropped.skipped, count - static_cast<std::int64_t>(FrameSynchroniser::kWaiting));
    EXPECT_TRUE(dropped.without_frame.empty());
  }
}

TEST(FrameSynchroniser, TwoCamerasOfEqualTimesKeepTheirFramesApart) {
  for (const bool newest_first : {true, false}) {
    FrameSynchroniser inbox(newest_first);
    inbox.add_frame({"LEFT", 1}, arrived_bytes(11));
    inbox.add_frame({"RIGHT", 1}, arrived_bytes(12));
    inbox.add_detections({"RIGHT", 1}, bytes(22));
    inbox.add_detections({"LEFT", 1}, bytes(21));
    for (int i = 0; i < 2; ++i) {
      const std::optional<SynchronisedMessages> pair = inbox.pop(kNow);
      ASSERT_TRUE(pair.has_value());
      const int camera = pair->id.channel == "LEFT" ? 1 : 2;
      EXPECT_EQ(*pair->frame, bytes(10 + camera));
      EXPECT_EQ(pair->detections, bytes(20 + camera));
    }
    EXPECT_EQ(inbox.pop_dropped().skipped, 0);
  }
}

TEST(FrameSynchroniser, AFastCameraDoesNotStarveASlowOne) {
  FrameSynchroniser inbox(true);
  int slow = 0;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 5; ++k) {
      inbox.add_frame({"FAST", 5 * i + k}, arrived_bytes(0));
      inbox.add_detections({"FAST", 5 * i + k}, bytes(0));
    }
    inbox.add_frame({"SLOW", i}, arrived_bytes(0));
    inbox.add_detections({"SLOW", i}, bytes(0));
    slow += inbox.pop(kNow)->id.channel == "SLOW" ? 1 : 0;
  }
  EXPECT_EQ(slow, 10) << "each has its turn";
}

TEST(FrameSynchroniser, OfTwoDetectorsEachKeepsItsNewestResult) {
  FrameSynchroniser inbox(true);
  for (int i = 1; i <= 3; ++i) {
    inbox.add_frame(id(i), arrived_bytes(10 + i));
    inbox.add_detections(id(i), bytes(20 + i));
    inbox.add_detections(id(i), bytes(30 + i));
  }
  EXPECT_EQ(inbox.pop(kNow)->detections, bytes(23));
  EXPECT_EQ(inbox.pop(kNow)->detections, bytes(33));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  EXPECT_EQ(inbox.pop_dropped().skipped, 4);
}

TEST(FrameSynchroniser, OtherCamerasFramesDoNotAgeWhatWaits) {
  FrameSynchroniser inbox(true);
  inbox.add_detections({"LEFT", 7}, bytes(1));
  for (int i = 0; i < 5 * FrameSynchroniser::kMaxLagFrames; ++i) inbox.add_frame({"RIGHT", i}, arrived_bytes(0));
  EXPECT_TRUE(inbox.pop_dropped().without_frame.empty());
  inbox.add_frame({"LEFT", 7}, arrived_bytes(2));
  EXPECT_TRUE(inbox.pop(kNow).has_value());
}

TEST(FrameSynchroniser, OldFramesAreForgotten) {
  FrameSynchroniser inbox(true);
  for (int i = 0; i <= static_cast<int>(FrameSynchroniser::kHistory); ++i) inbox.add_frame(id(i), arrived_bytes(0));
  inbox.add_detections(id(0), bytes(0));
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  inbox.add_detections(id(1), bytes(0));
  EXPECT_TRUE(inbox.pop(kNow).has_value());
}

TEST(FrameSynchroniser, LargeFramesAreKeptWithinABoundInBytes) {
  FrameSynchroniser inbox(true);
  const auto large = std::make_shared<const std::vector<std::uint8_t>>(FrameSynchroniser::kHistoryBytes / 8);
  for (int i = 0; i < 20; ++i) inbox.add_frame({"LEFT", i}, large);
  inbox.add_frame({"RIGHT", 1}, large);
  inbox.add_detections({"LEFT", 19}, {});
  EXPECT_TRUE(inbox.pop(kNow).has_value());
  inbox.add_detections({"RIGHT", 1}, {});
  EXPECT_TRUE(inbox.pop(kNow).has_value());
  inbox.add_detections({"LEFT", 5}, {});
  EXPECT_FALSE(inbox.pop(kNow).has_value()) << "the oldest ones are gone";
}

TEST(FrameSynchroniser, LargeFramesOfManyCamerasAreKeptWithinTheBoundToo) {
  FrameSynchroniser inbox(true);
  const auto large = std::make_shared<const std::vector<std::uint8_t>>(FrameSynchroniser::kHistoryBytes / 3);
  const auto kept = [&] { return static_cast<std::size_t>(large.use_count() - 1) * large->size(); };
  for (std::size_t i = 0; i < FrameSynchroniser::kCameras; ++i) {
    inbox.add_frame({std::to_string(i), 1}, large);
    EXPECT_LE(kept(), FrameSynchroniser::kHistoryBytes);
  }
  EXPECT_EQ(kept(), 3 * large->size());
  inbox.add_detections({"63", 1}, {});
  EXPECT_TRUE(inbox.pop(kNow).has_value()) << "the newest ones stay";
  inbox.add_detections({"0", 1}, {});
  EXPECT_FALSE(inbox.pop(kNow).has_value());
  std::size_t fresh = 0;
  while (inbox.pop_unmatched_frame()) ++fresh;
  EXPECT_EQ(fresh, 2U) << "what is gone is not taken ahead";
}

TEST(FrameSynchroniser, TheLastFrameStaysHoweverLargeItIs) {
  FrameSynchroniser inbox(true);
  const auto large = std::make_shared<const std::vector<std::uint8_t>>(FrameSynchroniser::kHistoryBytes + 1);
  inbox.add_frame({"LEFT", 1}, arrived_bytes(1));
  inbox.add_frame({"RIGHT", 1}, large);
  inbox.add_detections({"RIGHT", 1}, {});
  EXPECT_TRUE(inbox.pop(kNow).has_value());
  inbox.add_detections({"LEFT", 1}, {});
  EXPECT_FALSE(inbox.pop(kNow).has_value());
}

TEST(FrameSynchroniser, ListensToAFewCamerasOnly) {
  FrameSynchroniser inbox(true);
  for (std::size_t i = 0; i < FrameSynchroniser::kCameras; ++i)
    inbox.add_frame({std::to_string(i), 1}, arrived_bytes(1));
  EXPECT_THROW(inbox.add_frame({"one more", 1}, arrived_bytes(1)), InputError);
  EXPECT_THROW(inbox.add_detections({"one more", 1}, {1}), InputError);
  EXPECT_NO_THROW(inbox.add_frame({"0", 2}, arrived_bytes(1)));
}

TEST(FrameSynchroniser, LargeDetectionsOfManyCamerasAreKeptWithinABound) {
  FrameSynchroniser inbox(false);
  constexpr int kCameras = 3;
  for (int i = 0; i < 60; ++i) {
    for (int camera = 0; camera < kCameras; ++camera)
      inbox.add_detections({std::to_string(camera), i}, std::vector<std::uint8_t>(Reception::kMaxResultBytes));
  }
  constexpr std::size_t kMax = FrameSynchroniser::kAllWaitingBytes / Reception::kMaxResultBytes;
  EXPECT_EQ(inbox.pop_dropped().without_frame.size(), kCameras * 60 - kMax);
  for (int camera = 0; camera < kCameras; ++camera) inbox.add_frame({std::to_string(camera), 59}, arrived_bytes(1));
  for (int camera = 0; camera < kCameras; ++camera) EXPECT_TRUE(inbox.pop(kNow).has_value());
}

}  // namespace
}  // namespace houghstream
