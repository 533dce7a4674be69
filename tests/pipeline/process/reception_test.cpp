#include "pipeline/process/reception.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "pipeline/base/checks.hpp"
#include "pipeline/bus/event_log.hpp"
#include "tests/pipeline/process_test.hpp"

namespace houghstream {
namespace {

using std::chrono::milliseconds;

/// Holds a reception on a bus within this thread.
struct TestReception {
  explicit TestReception(const std::string& frame_channels) : reception(bus, status, frame_channels) {}

  void send(const std::string& name, const std::vector<std::uint8_t>& bytes) {
    bus.publish(name, {bytes.data(), bytes.size()}, 0);
    bus.handle(milliseconds(1000));
  }

  LcmBus bus{"memq://"};
  StatusReporter status{"test"};
  Reception reception;
};

TEST(Reception, WhatIsNoFrameIsPassedOverOnAPatternAndABadFrameOnAName) {
  const std::vector<std::uint8_t> noise(50, 0x5A);
  for (const bool is_pattern : {true, false}) {
    TestReception test(is_pattern ? "LEFT|RIGHT" : "LEFT");
    std::vector<FrameId> frames;
    test.reception.subscribe_to_frames(CountedAs::kReceived,
                                       [&](const ReceivedFrame& frame) { frames.push_back(frame.id); });
    test.send("LEFT", noise);
    test.send("LEFT", encode_message(to_message(make_test_frame(7), WireFormat{}, 0)));
    EXPECT_EQ(frames, std::vector<FrameId>({{"LEFT", 7}}));
    EXPECT_EQ(test.status.message().frames_received, is_pattern ? 1 : 2);
    EXPECT_EQ(test.status.message().frames_refused, is_pattern ? 0 : 1);
  }
}

TEST(Reception, WhatAHandlerRefusesIsCountedAsItsSubscriptionIs) {
  for (const CountedAs counted_as : {CountedAs::kReceived, CountedAs::kOther}) {
    TestReception test(channel::kFrame);
    test.reception.subscribe_to_results<detections_t>(channel::kDetections, counted_as,
                                                      [](const ReceivedResult&) { fail("there is no room"); });
    test.send(channel::kDetections, encode_message(to_message(one_bowl(1))));
    const std::int64_t counted = counted_as == CountedAs::kReceived ? 1 : 0;
    EXPECT_EQ(test.status.message().frames_received, counted);
    EXPECT_EQ(test.status.message().frames_refused, counted);
    EXPECT_EQ(test.status.message().last_error, "message on HOUGHSTREAM_DETECTIONS: there is no room");
  }
}

TEST(Reception, OnlyTheOtherCamerasHandlerHearsOfItsResults) {
  TestReception test("LEFT|RIGHT");
  std::vector<FrameId> own;
  std::vector<FrameId> others;
  test.reception.subscribe_to_results<detections_t>(
      channel::kDetections, CountedAs::kReceived, [&](const ReceivedResult& result) { own.push_back(result.id); },
      [&](const FrameId& frame) { others.push_back(frame); });
  test.send(channel::kDetections, encode_message(to_message(one_bowl(1, "RIGHT"))));
  test.send(channel::kDetections, encode_message(to_message(one_bowl(2, "THIRD"))));
  EXPECT_EQ(own, std::vector<FrameId>({{"RIGHT", 1}}));
  EXPECT_EQ(others, std::vector<FrameId>({{"THIRD", 2}}));
  EXPECT_EQ(test.status.message().frames_received, 1);
}

TEST(Reception, TheClockOfALogGoesForwardWithItsEventsOnly) {
  const auto file = std::filesystem::temp_directory_path() / ("reception_test." + std::to_string(getpid()));
  LogWriter writer(file);
  const std::vector<std::uint8_t> bytes = encode_message(to_message(one_bowl(1)));
  for (const std::int64_t event_us : {1000, 1300, 50, 60}) writer.write(event_us, "X", {bytes.data(), bytes.size()});
  writer.close();
  LcmBus bus("file://" + file.string());
  StatusReporter status("test");
  Reception reception(bus, status, channel::kFrame);
  std::vector<std::int64_t> times;
  reception.subscribe_to_messages<detections_t>(
      "X", [&](const detections_t&, const ReceivedMessage&) { times.push_back(reception.now_us()); });
  while (bus.handle(milliseconds(0))) {
  }
  EXPECT_EQ(times, (std::vector<std::int64_t>{0, 300, 300, 310}));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace houghstream
