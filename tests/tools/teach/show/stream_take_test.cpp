#include "tools/teach/show/stream_take.hpp"

#include <gtest/gtest.h>

#include <csignal>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/messages/messages.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

namespace houghstream::teach {
namespace {

using std::chrono::milliseconds;

StreamTakeSettings quick() {
  StreamTakeSettings settings;
  settings.longest = milliseconds(5000);
  settings.patience = milliseconds(300);
  settings.silence = milliseconds(300);
  return settings;
}

void send(LcmBus& bus, std::int64_t utime, const std::string& channel = channel::kFrame) {
  bus.publish(channel, to_message(make_test_frame(utime), WireFormat{}, utime));
}

TEST(StreamTake, FramesComeInOrderUntilTheStreamEnds) {
  LcmBus bus("memq://");
  StreamTake take(bus, quick());
  for (std::int64_t i = 1; i <= 20; ++i) send(bus, i);
  send(bus, 99, "OTHER_CAMERA");
  for (std::int64_t i = 1; i <= 20; ++i) {
    const std::optional<RgbdFrame> frame = take.next();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->id, (FrameId{channel::kFrame, i}));
  }
  EXPECT_FALSE(take.next().has_value()) << "nothing more has come";
  EXPECT_FALSE(take.next().has_value()) << "and it stays so";
  EXPECT_EQ(take.passed_over(), 0);
}

TEST(StreamTake, ItEndsWhenAskedAndAfterItsLongestTime) {
  LcmBus bus("memq://");
  StreamTakeSettings settings = quick();
  settings.longest = milliseconds(400);
  settings.silence = milliseconds(5000);
  StreamTake take(bus, settings);
  send(bus, 1);
  EXPECT_TRUE(take.next().has_value());
  EXPECT_FALSE(take.next().has_value()) << "after 0.4 s";

  LcmBus other("memq://");
  StreamTake ended(other, quick());
  send(other, 1);
  EXPECT_TRUE(ended.next().has_value());
  send(other, 2);
  ended.end();
  EXPECT_FALSE(ended.next().has_value()) << "what waits is left";
}

TEST(StreamTake, WhatIsOldIsSkippedWhereOnlyNowCounts) {
  LcmBus bus("memq://");
  StreamTake take(bus, quick());
  for (std::int64_t i = 1; i <= 20; ++i) send(bus, i);
  EXPECT_EQ(take.next()->id.utime, 1);
  std::this_thread::sleep_for(milliseconds(200));
  take.skip_to_newest();
  EXPECT_EQ(take.next()->id.utime, 20);
  take.skip_to_newest();
  EXPECT_FALSE(take.next().has_value());
  EXPECT_EQ(take.passed_over(), 0) << "nobody was too slow";
}

TEST(StreamTake, WhatWasSkippedTakesNoRoom) {
  LcmBus bus("memq://");
  StreamTake take(bus, quick());
  images_t large = to_message(make_test_frame(1), WireFormat{}, 1);
  large.images.front().data.resize(std::size_t{8} << 20U);
  large.images.front().size = static_cast<std::int32_t>(large.images.front().data.size());
  for (int i = 0; i < 40; ++i) {  // more than may wait
    bus.publish(channel::kFrame, large);
    std::this_thread::sleep_for(milliseconds(10));
    take.skip_to_newest();
  }
  for (std::int64_t i = 2; i <= 4; ++i) send(bus, i);
  std::this_thread::sleep_for(milliseconds(100));
  EXPECT_EQ(take.passed_over(), 0);
}

TEST(StreamTake, WhatComesTooFastGoesWithACount) {
  LcmBus bus("memq://");
  StreamTake take(bus, quick());
  for (std::int64_t i = 1; i <= 400; ++i) {
    send(bus, i);
    if (i % 50 == 0) std::this_thread::sleep_for(milliseconds(30));  // LCM's own queue is short
  }
  std::int64_t frames = 0;
  std::int64_t last = 0;
  while (const std::optional<RgbdFrame> frame = take.next()) {
    ++frames;
    last = frame->id.utime;
  }
  EXPECT_EQ(last, 400) << "the newest stay";
  EXPECT_EQ(frames, 300);
  EXPECT_GE(take.passed_over(), 1);
}

TEST(StreamTake, WithoutAStreamOrWithRubbishOneLineSaysSo) {
  LcmBus bus("memq://");
  StreamTake take(bus, quick());
  EXPECT_NE(error_of([&] { take.next(); }).find("no frame within 0 s on OPENNI_FRAME at memq://"), std::string::npos);
  const std::vector<std::uint8_t> rubbish(20, 7);
  bus.publish(channel::kFrame, {rubbish.data(), rubbish.size()}, 0);
  LcmBus second("memq://");
  StreamTake other(second, quick());
  second.publish(channel::kFrame, {rubbish.data(), rubbish.size()}, 0);
  EXPECT_NE(error_of([&] { other.next(); }).find("OPENNI_FRAME: message of fingerprint"), std::string::npos);
  StreamTakeSettings several = quick();
  several.channel = "LEFT|RIGHT";
  EXPECT_NE(error_of([&] { StreamTake none(bus, several); }).find("expected the name of one camera's"),
            std::string::npos);
}

TEST(StreamTake, CtrlCEndsTheTake) {
  catch_stop_signals();
  LcmBus bus("memq://");
  StreamTake take(bus, quick());
  send(bus, 1);
  EXPECT_TRUE(take.next().has_value());
  std::raise(SIGINT);
  send(bus, 2);
  EXPECT_FALSE(take.next().has_value());
}

}  // namespace
}  // namespace houghstream::teach
