#include "tools/teach/show/stream_take.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <thread>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/messages/messages.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tests/test_files.hpp"

namespace houghstream::teach {
namespace {

using std::chrono::milliseconds;

/// For a machine that may be busy: nothing ends the take but its test.
StreamTakeSettings patient() {
  StreamTakeSettings settings;
  settings.max_length = settings.first_frame_timeout = settings.frame_timeout = milliseconds(60'000);
  return settings;
}

StreamTakeSettings quick() {
  StreamTakeSettings settings;
  settings.max_length = milliseconds(5000);
  settings.first_frame_timeout = milliseconds(300);
  settings.frame_timeout = milliseconds(300);
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
  settings.max_length = milliseconds(400);
  settings.frame_timeout = milliseconds(5000);
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

void send_rubbish(LcmBus& bus) {
  const std::vector<std::uint8_t> rubbish(20, 7);
  bus.publish(channel::kFrame, {rubbish.data(), rubbish.size()}, 0);
}

TEST(StreamTake, WithoutAStreamOrWithRubbishAloneOneLineSaysSo) {
  LcmBus bus("memq://");
  StreamTake take(bus, quick());
  EXPECT_NE(error_of([&] { take.next(); }).find("no frame within 0 s on OPENNI_FRAME at memq://"), std::string::npos);
  LcmBus second("memq://");
  StreamTake other(second, quick());
  send_rubbish(second);
  send_rubbish(second);
  EXPECT_NE(error_of([&] { other.next(); }).find("2 messages were refused, the last: message of fingerprint"),
            std::string::npos);
  StreamTakeSettings several = quick();
  several.channel = "LEFT|RIGHT";
  EXPECT_NE(error_of([&] { StreamTake none(bus, several); }).find("expected the name of one camera's"),
            std::string::npos);
}

/// Frames with nothing, something or everything wrong, in the order of their numbers.
void send_amid_rubbish(LcmBus& bus) {
  send_rubbish(bus);
  send(bus, 1);
  images_t damaged = to_message(make_test_frame(2), WireFormat{}, 2);
  damaged.images.front().data.assign(damaged.images.front().data.size(), 7);
  bus.publish(channel::kFrame, damaged);
  images_t blind = to_message(make_test_frame(3), WireFormat{}, 3);
  for (image_t& image : blind.images) {
    image.metadata.clear();
    image.nmetadata = 0;
  }
  bus.publish(channel::kFrame, blind);
  bus.publish(channel::kFrame, to_message(make_test_frame(4, 8, 8), WireFormat{}, 4));
  send_rubbish(bus);
  send(bus, 5);
}

TEST(StreamTake, WhatIsNoFrameIsSaidOnceAndCountedWhileTheTakeGoesOn) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  LcmBus bus("memq://");
  StreamTake take(bus, patient());
  send_amid_rubbish(bus);
  EXPECT_EQ(take.next()->id.utime, 1);
  EXPECT_EQ(take.next()->id.utime, 5);
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(take.refused(), 5);
  EXPECT_EQ(take.passed_over(), 0);
  EXPECT_LT(std::count(log.begin(), log.end(), '\n'), 5) << log;
  EXPECT_NE(log.find("message on OPENNI_FRAME dropped: message of fingerprint"), std::string::npos) << log;
}

TEST(StreamTake, RubbishDoesNotKeepATakeWithoutFramesAlive) {
  LcmBus bus("memq://");
  StreamTake take(bus, quick());
  send(bus, 1);
  EXPECT_TRUE(take.next().has_value());
  std::atomic<bool> done{false};
  std::thread sender([&] {
    images_t damaged = to_message(make_test_frame(2), WireFormat{}, 2);
    damaged.images.front().data.assign(damaged.images.front().data.size(), 7);
    while (!done) {
      send_rubbish(bus);
      bus.publish(channel::kFrame, damaged);
      std::this_thread::sleep_for(milliseconds(10));
    }
  });
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(take.next().has_value());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(4000)) << "silence is 0.3 s, the longest take 5 s";
  done = true;
  sender.join();
}

TEST(StreamTake, RubbishTakesNoFramesPlace) {
  LcmBus bus("memq://");
  StreamTake take(bus, patient());
  send(bus, 1);
  for (int i = 0; i < 400; ++i) {  // more than may wait
    send_rubbish(bus);
    while (i - take.refused() > 50) std::this_thread::sleep_for(milliseconds(1));  // LCM's own queue is short
  }
  send(bus, 2);
  EXPECT_EQ(take.next()->id.utime, 1);
  EXPECT_EQ(take.next()->id.utime, 2);
  EXPECT_EQ(take.passed_over(), 0);
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
