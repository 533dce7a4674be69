#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <thread>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/base/stop_signal.hpp"
#include "pipeline/bus/event_log.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "tests/pipeline/test_frame.hpp"
#include "tools/capture/publish_frames.hpp"

namespace houghstream::capture {
namespace {

/// Frames at 1000, 2000, ...
class FakeSource : public FrameSource {
 public:
  explicit FakeSource(int frames) : left_(frames) {}
  std::optional<RgbdFrame> next() override {
    if (left_ == 0) return std::nullopt;
    --left_;
    return make_test_frame(1000 + 1000 * count_++);
  }
  double rate_hz() const override { return 1e3; }

 private:
  int left_;
  int count_ = 0;
};

/// Simulates a recording of 20 Hz whose stamps tremble.
class UnevenSource : public FrameSource {
 public:
  std::optional<RgbdFrame> next() override {
    constexpr std::array<std::int64_t, 3> kUtimes = {1000, 51003, 100999};
    if (count_ == kUtimes.size()) return std::nullopt;
    return make_test_frame(kUtimes[count_++]);
  }
  double rate_hz() const override { return 20.0; }

 private:
  std::size_t count_ = 0;
};

class CaptureLog : public testing::Test {
 protected:
  CaptureLog() : file(std::filesystem::temp_directory_path() / ("capture_test." + std::to_string(getpid()))) {
    catch_stop_signals();
  }
  ~CaptureLog() override { std::filesystem::remove(file); }

  /// Timestamps, frame times and frame counters of what was written.
  struct Line {
    std::int64_t timestamp = 0;
    std::int64_t utime = 0;
    std::int64_t sequence = 0;
  };
  std::vector<Line> capture(int frames_in_source, const CaptureSettings& settings) const {
    capture_to_log([&](const openni::CameraListener&) { return std::make_unique<FakeSource>(frames_in_source); },
                   settings, file.string());
    std::vector<Line> lines;
    LogReader reader(file);
    while (const std::optional<LogEvent> event = reader.next()) {
      const FrameHeader header = read_frame_header({event->data.data(), event->data.size()});
      EXPECT_EQ(event->channel, settings.channel);
      lines.push_back({event->timestamp, header.utime, header.sequence.value_or(-1)});
    }
    return lines;
  }

  const std::filesystem::path file;
};

TEST_F(CaptureLog, HoldsTheSourcesFrames) {
  const std::vector<Line> lines = capture(4, CaptureSettings{});
  ASSERT_EQ(lines.size(), 4U);
  for (std::int64_t i = 0; i < 4; ++i) {
    EXPECT_EQ(lines[i].utime, 1000 + 1000 * i);
    EXPECT_EQ(lines[i].timestamp, 1000 + 1000 * i);
    EXPECT_EQ(lines[i].sequence, i);
  }
}

TEST_F(CaptureLog, IsStampedAtTheRateAskedFor) {
  CaptureSettings settings;
  settings.rate_hz = 10.0;
  const std::vector<Line> lines = capture(3, settings);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[2].timestamp, 1000 + 200000);
  EXPECT_EQ(lines[2].utime, 1000 + 200000) << "what is played faster or slower is so by its own stamps too";
}

TEST_F(CaptureLog, KeepsTheStampsOfARecordingAtItsOwnRate) {
  CaptureSettings settings;
  settings.rate_hz = 20.0;
  const auto uneven = [](const openni::CameraListener&) { return std::make_unique<UnevenSource>(); };
  capture_to_log(uneven, settings, file.string());
  std::vector<std::int64_t> utimes;
  LogReader reader(file);
  while (const std::optional<LogEvent> event = reader.next())
    utimes.push_back(read_frame_header({event->data.data(), event->data.size()}).utime);
  EXPECT_EQ(utimes, (std::vector<std::int64_t>{1000, 51003, 100999})) << "a frame is known by its stamp";
}

TEST_F(CaptureLog, IsStampedAtTheRateAskedForOverLoopsToo) {
  CaptureSettings settings;
  settings.rate_hz = 15.0;
  settings.loop = true;
  settings.frames = 7;
  const std::vector<Line> lines = capture(3, settings);
  ASSERT_EQ(lines.size(), 7U);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].utime, 1000 + std::llround(static_cast<double>(i) * 1e6 / 15.0)) << i;
    EXPECT_EQ(lines[i].utime, lines[i].timestamp) << i;
  }
}

TEST_F(CaptureLog, LoopsWithoutRepeatingATime) {
  CaptureSettings settings;
  settings.loop = true;
  settings.frames = 8;
  const std::vector<Line> lines = capture(3, settings);
  ASSERT_EQ(lines.size(), 8U);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].utime, 1000 + 1000 * static_cast<std::int64_t>(i));
    EXPECT_EQ(lines[i].sequence, static_cast<std::int64_t>(i));
  }
}

/// Simulates a camera whose frames end with a stop signal.
class StoppedSource : public FrameSource {
 public:
  std::optional<RgbdFrame> next() override {
    if (given_++ == 0) return make_test_frame(1000);
    std::raise(SIGTERM);
    return std::nullopt;
  }
  double rate_hz() const override { return 1e3; }

 private:
  int given_ = 0;
};

TEST_F(CaptureLog, WhatIsStoppedIsNotStartedAgain) {
  CaptureSettings settings;
  settings.loop = true;
  settings.frames = 8;
  int opened = 0;
  const auto open = [&](const openni::CameraListener&) {
    ++opened;
    return std::make_unique<StoppedSource>();
  };
  EXPECT_EQ(capture_to_log(open, settings, file.string()).frames, 1);
  EXPECT_EQ(opened, 1);
  catch_stop_signals();  // forgets the signal
}

TEST_F(CaptureLog, RefusesWhatMakesNoSense) {
  EXPECT_THROW(capture(0, CaptureSettings{}), InputError);
  CaptureSettings settings;
  settings.loop = true;
  EXPECT_THROW(capture(0, settings), InputError);
  settings = CaptureSettings{};
  for (const double none : {0.0, 1e-300}) {
    settings.rate_hz = none;
    EXPECT_THROW(capture(3, settings), InputError) << none;
  }
  settings = CaptureSettings{};
  settings.format.jpeg_quality = 1000;
  EXPECT_THROW(capture(3, settings), InputError);
  settings = CaptureSettings{};
  for (const std::string& channel : {std::string(), std::string(64, 'x')}) {
    settings.channel = channel;
    EXPECT_THROW(capture(3, settings), InputError);
    EXPECT_FALSE(std::filesystem::exists(file)) << "LCM cannot send on it";
  }
}

class LiveSource : public FakeSource {
 public:
  LiveSource() : FakeSource(1) {}
  bool is_live() const override { return true; }
};

TEST_F(CaptureLog, ACameraHasNoEndToStartAgainAt) {
  CaptureSettings settings;
  settings.loop = true;
  settings.frames = 3;
  const auto open = [](const openni::CameraListener&) { return std::make_unique<LiveSource>(); };
  EXPECT_THROW(capture_to_log(open, settings, file.string()), InputError);
}

/// Asks this process to end, a moment after it was made.
class StopSoon {
 public:
  StopSoon()
      : hand_([] {
          std::this_thread::sleep_for(std::chrono::milliseconds(200));
          kill(getpid(), SIGTERM);
        }) {}
  StopSoon(const StopSoon&) = delete;
  StopSoon& operator=(const StopSoon&) = delete;
  ~StopSoon() {
    hand_.join();
    catch_stop_signals();  // forgets the signal
  }

 private:
  std::thread hand_;
};

TEST(Capture, EndsSoonAfterASignalHoweverFarTheNextFrameIs) {
  catch_stop_signals();
  CaptureSettings settings;
  settings.rate_hz = 0.1;
  const StopSoon stop_soon;
  const CaptureResult result = capture_to_network(
      [](const openni::CameraListener&) { return std::make_unique<FakeSource>(3); }, settings, "memq://");
  EXPECT_EQ(result.frames, 1) << "the second one's turn had not come";
  EXPECT_LT(result.seconds, 1.0);
}

/// A source that lets its first frame be waited for until a status is due.
class SlowSource : public FrameSource {
 public:
  std::optional<RgbdFrame> next() override {
    std::this_thread::sleep_for(std::chrono::milliseconds(1300));
    return make_test_frame(1000);
  }
  double rate_hz() const override { return 1e3; }
};

TEST(Capture, ABusThatCannotBeReachedEndsNothingAndFramesThatAreNotSentDoNotCount) {
  catch_stop_signals();
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  CaptureSettings settings;
  settings.frames = 2;
  const CaptureResult result =
      capture_to_network([](const openni::CameraListener&) { return std::make_unique<SlowSource>(); }, settings,
                         "tcpq://127.0.0.1:1");  // without a server
  EXPECT_EQ(result.frames, 0);
  const std::string log = testing::internal::GetCapturedStderr();
  const std::size_t said = log.find("not connected to the server");
  EXPECT_NE(said, std::string::npos) << log;
  EXPECT_EQ(log.find("not connected to the server", said + 1), std::string::npos) << log;
}

TEST(Capture, KeepsTheRateOnTheNetwork) {
  catch_stop_signals();
  CaptureSettings settings;
  settings.rate_hz = 50.0;
  const CaptureResult result = capture_to_network(
      [](const openni::CameraListener&) { return std::make_unique<FakeSource>(11); }, settings, "memq://");
  EXPECT_EQ(result.frames, 11);
  EXPECT_GE(result.seconds, 0.19);
  EXPECT_GT(result.bytes, 11 * 1000);
}

}  // namespace
}  // namespace houghstream::capture
