#include "pipeline/bus/status_reporter.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/channels.hpp"

namespace houghstream {
namespace {

TEST(StatusReporter, CountsWhatItIsTold) {
  StatusReporter status("hs-test");
  for (int i = 0; i < 10; ++i) status.count_received();
  status.count_skipped(3);
  for (int i = 1; i <= 6; ++i) status.count_processed(std::chrono::milliseconds(10 * i));
  status.count_refused("a broken frame");
  const status_t message = status.message();
  EXPECT_EQ(message.process, "hs-test");
  EXPECT_EQ(message.pid, getpid());
  EXPECT_GT(message.utime, 1600000000000000);
  EXPECT_EQ(message.frames_received, 10);
  EXPECT_EQ(message.frames_processed, 6);
  EXPECT_EQ(message.frames_skipped, 3);
  EXPECT_EQ(message.frames_refused, 1);
  EXPECT_EQ(message.rate_hz, 6.0F);
  EXPECT_FLOAT_EQ(message.latency_p50_ms, 30.0F);
  EXPECT_FLOAT_EQ(message.latency_p99_ms, 60.0F);
  EXPECT_EQ(message.last_error, "a broken frame");
}

TEST(StatusReporter, GapsInTheNumberingAreLostFrames) {
  StatusReporter status("hs-test");
  EXPECT_EQ(status.message().frames_lost, -1) << "without a number it cannot be told";
  EXPECT_TRUE(std::isnan(status.message().latency_p50_ms));
  status.note_number({});
  EXPECT_EQ(status.message().frames_lost, -1);
  for (const std::int64_t sequence : {5, 6, 9, 10}) status.note_number({sequence, sequence, 0});
  EXPECT_EQ(status.message().frames_lost, 2);
  for (const std::int64_t sequence : {0, 1, 3}) status.note_number({sequence, sequence, 0});
  EXPECT_EQ(status.message().frames_lost, 3) << "a new run starts at 0 and loses nothing by it";
}

TEST(StatusReporter, EachCameraHasANumberingOfItsOwn) {
  StatusReporter status("hs-test");
  for (const std::int64_t sequence : {0, 1, 2}) {
    status.note_number({sequence, sequence, 0}, "LEFT");
    status.note_number({100 + 2 * sequence, sequence, 0}, "RIGHT");
  }
  EXPECT_EQ(status.message().frames_lost, 2);
}

TEST(StatusReporter, AFloodOfErrorsIsCountedAndSaidOnceASecondOfEachKind) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  StatusReporter status("hs-test");
  for (int i = 0; i < 50; ++i) {
    status.count_refused("bad frame", "frame");
    status.count_refused("no pose", "work");
    status.note_bad_message("bad status");
  }
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 3) << log;
  EXPECT_EQ(status.message().frames_refused, 100);
  EXPECT_NE(status.summary().find("100 refused; 50 other bad messages"), std::string::npos) << status.summary();
}

TEST(StatusReporter, IsPublishedOnceASecond) {
  LcmBus bus("memq://");
  int seen = 0;
  bus.subscribe(channel::kStatus, [&](const ReceivedMessage& arrival) {
    EXPECT_EQ(decode_message<status_t>(arrival.bytes).process, "hs-test");
    ++seen;
  });
  StatusReporter status("hs-test");
  for (int i = 0; i < 12; ++i) {
    status.publish_if_due(bus);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  status.publish_if_due(bus);
  bus.handle(std::chrono::milliseconds(10));
  bus.handle(std::chrono::milliseconds(10));
  EXPECT_EQ(seen, 1);
}

TEST(StatusReporter, ABusThatDoesNotTakeItIsToldAndSurvived) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  const auto file = std::filesystem::temp_directory_path() / ("status_reporter_test." + std::to_string(getpid()));
  LogWriter writer(file);
  writer.write(0, "X", {});
  writer.close();
  LcmBus bus("file://" + file.string());  // without an output log
  StatusReporter status("hs-test");
  EXPECT_FALSE(status.try_publish_if_due(bus)) << "not due";
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  EXPECT_FALSE(status.try_publish_if_due(bus));
  EXPECT_NE(testing::internal::GetCapturedStderr().find("no status: file://"), std::string::npos);
  EXPECT_NE(status.message().last_error.find("cannot take results"), std::string::npos);
  EXPECT_THROW(status.publish(bus), InputError);
  std::filesystem::remove(file);
}

TEST(StatusReporter, AnErrorThatQuotesAMessageIsCut) {
  StatusReporter status("test");
  status.count_refused(std::string(100'000, 'x'));
  EXPECT_EQ(status.message().last_error, std::string(1000, 'x') + "...");
  status.set_last_error(std::string(100'000, 'y'));
  EXPECT_EQ(status.message().last_error, std::string(1000, 'y') + "...");
}

}  // namespace
}  // namespace houghstream
