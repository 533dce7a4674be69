#include "pipeline/process/pair_inbox.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

constexpr std::chrono::milliseconds kNow(0);

std::vector<std::uint8_t> bytes(int value) {
  return {static_cast<std::uint8_t>(value)};
}

TEST(PairInbox, PairsWhicheverComesFirst) {
  PairInbox inbox(true);
  inbox.put_frame(1, bytes(11));
  EXPECT_FALSE(inbox.take(kNow).has_value());
  inbox.put_detections(1, bytes(21));
  std::optional<FramePair> pair = inbox.take(kNow);
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(pair->frame, bytes(11));
  EXPECT_EQ(pair->detections, bytes(21));

  inbox.put_detections(2, bytes(22));
  EXPECT_FALSE(inbox.take(kNow).has_value());
  inbox.put_frame(2, bytes(12));
  pair = inbox.take(kNow);
  ASSERT_TRUE(pair.has_value());
  EXPECT_EQ(pair->frame, bytes(12));
  EXPECT_FALSE(inbox.take(kNow).has_value());
}

TEST(PairInbox, NeverPairsAnotherFrame) {
  PairInbox inbox(true);
  inbox.put_frame(1, bytes(11));
  inbox.put_frame(3, bytes(13));
  inbox.put_detections(2, bytes(22));
  EXPECT_FALSE(inbox.take(kNow).has_value());
}

TEST(PairInbox, NewestFirstPassesOverOlderOnes) {
  PairInbox inbox(true);
  for (int i = 1; i <= 3; ++i) {
    inbox.put_frame(i, bytes(10 + i));
    inbox.put_detections(i, bytes(20 + i));
  }
  EXPECT_EQ(inbox.take(kNow)->detections, bytes(23));
  EXPECT_FALSE(inbox.take(kNow).has_value());
  EXPECT_EQ(inbox.take_dropped().skipped, 2);
  EXPECT_EQ(inbox.take_dropped().skipped, 0);
}

TEST(PairInbox, TheNewestFrameMayBeTakenAheadOnce) {
  PairInbox inbox(true);
  EXPECT_FALSE(inbox.take_fresh().has_value());
  inbox.put_frame(1, bytes(11));
  inbox.put_frame(2, bytes(12));
  EXPECT_FALSE(inbox.take(std::chrono::minutes(1)).has_value()) << "does not wait: a frame has come";
  const std::optional<ArrivedFrame> fresh = inbox.take_fresh();
  ASSERT_TRUE(fresh.has_value());
  EXPECT_EQ(fresh->utime, 2);
  EXPECT_EQ(fresh->bytes, bytes(12));
  EXPECT_FALSE(inbox.take_fresh().has_value());
  inbox.put_detections(2, bytes(22));
  EXPECT_EQ(inbox.take(kNow)->frame, bytes(12)) << "it stays for its detections";

  inbox.put_frame(3, bytes(13));
  inbox.put_detections(3, bytes(23));
  EXPECT_TRUE(inbox.take(kNow).has_value());
  EXPECT_FALSE(inbox.take_fresh().has_value()) << "its pair has been taken";
}

TEST(PairInbox, ALogIsWorkedOnInTurn) {
  PairInbox inbox(false);
  for (int i = 1; i <= 3; ++i) {
    inbox.put_frame(i, bytes(10 + i));
    inbox.put_detections(i, bytes(20 + i));
  }
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(inbox.take(kNow)->detections, bytes(20 + i));
  EXPECT_EQ(inbox.take_dropped().skipped, 0);
}

TEST(PairInbox, DetectionsWithoutAFrameAreGivenUpInTheEnd) {
  PairInbox inbox(true);
  inbox.put_detections(-5, bytes(1));
  for (int i = 0; i < PairInbox::kWait; ++i) inbox.put_frame(i, bytes(i));
  EXPECT_TRUE(inbox.take_dropped().without_frame.empty());
  inbox.put_frame(100, bytes(0));
  EXPECT_EQ(inbox.take_dropped().without_frame, std::vector<std::int64_t>{-5});

  inbox.put_detections(200, bytes(2));
  inbox.give_up_waiting();
  EXPECT_EQ(inbox.take_dropped().without_frame, std::vector<std::int64_t>{200});
}

TEST(PairInbox, MemoryIsBoundedWhereFramesNeverCome) {
  PairInbox inbox(true);
  const int count = 500;
  for (int i = 0; i < count; ++i) inbox.put_detections(i, bytes(0));
  EXPECT_EQ(inbox.take_dropped().without_frame.size(), count - PairInbox::kHistory);
}

TEST(PairInbox, OldFramesAreForgotten) {
  PairInbox inbox(true);
  for (int i = 0; i <= static_cast<int>(PairInbox::kHistory); ++i) inbox.put_frame(i, bytes(0));
  inbox.put_detections(0, bytes(0));
  EXPECT_FALSE(inbox.take(kNow).has_value());
  inbox.put_detections(1, bytes(0));
  EXPECT_TRUE(inbox.take(kNow).has_value());
}

}  // namespace
}  // namespace houghstream
