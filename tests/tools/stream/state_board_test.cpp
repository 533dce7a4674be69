#include "tools/stream/state_board.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace houghstream::stream {
namespace {

using std::chrono::seconds;

status_t status_of(pid_t pid, float rate_hz) {
  status_t status{};
  status.pid = pid;
  status.rate_hz = rate_hz;
  status.latency_p50_ms = std::numeric_limits<float>::quiet_NaN();
  return status;
}

TEST(StatusBoard, TellsTheStreamsStateInOneLine) {
  StatusBoard board;
  const auto now = StatusBoard::Clock::now();
  status_t detect = status_of(10, 9.84F);
  detect.latency_p50_ms = 119.4F;
  detect.frames_lost = 3;
  detect.frames_refused = 2;
  detect.last_error = "no camera";
  board.note(detect, now);
  board.note(status_of(11, 30.0F), now - seconds(4));
  board.note(status_of(12, 30.0F), now);
  const std::string line =
      board.line({{"detect", 10, 0}, {"pose", 11, 0}, {"view", 0, 2}, {"capture", 12, 1}, {"new", 13, 0}}, now);
  EXPECT_EQ(board.line({{"capture", 0, 0, true}}, now), "capture waits for the others");
  EXPECT_EQ(line,
            "detect 9.8 Hz 119 ms, 3 lost, 2 refused: no camera | pose silent | view down (restarts: 2) | "
            "capture 30.0 Hz (restarts: 1) | new silent");
}

TEST(StatusBoard, ShowsNothingThatSteersATerminal) {
  StatusBoard board;
  const auto now = StatusBoard::Clock::now();
  status_t status = status_of(10, 1.0F);
  status.frames_refused = 1;
  status.last_error = "\x1b]0;mine\x07" + std::string(1000, 'a');
  board.note(status, now);
  const std::string line = board.line({{"detect", 10, 0}}, now);
  EXPECT_EQ(line.find('\x1b'), std::string::npos);
  EXPECT_NE(line.find("\\x1b]0;mine\\x07"), std::string::npos) << line;
  EXPECT_LT(line.size(), 400U);
}

TEST(StatusBoard, ForgetsProcessesThatAreGone) {
  StatusBoard board;
  const auto now = StatusBoard::Clock::now();
  board.note(status_of(10, 1.0F), now);
  board.keep({{"detect", 11, 1}});
  EXPECT_EQ(board.line({{"detect", 10, 0}}, now), "detect silent");
}

using std::chrono::milliseconds;

status_t status_of(pid_t pid, std::int64_t received, std::int64_t processed) {
  status_t status{};
  status.pid = pid;
  status.frames_received = received;
  status.frames_processed = processed;
  return status;
}

TEST(DrainMonitor, AreThroughWhenEachHasNothingLeftAfterTheOneBefore) {
  const DrainMonitor::Clock::time_point ended{};
  DrainMonitor frames({10, 20}, ended);
  frames.note(status_of(20, 5, 5), ended + milliseconds(200));
  frames.note(status_of(10, 6, 6), ended + milliseconds(50));
  EXPECT_FALSE(frames.is_drained()) << "the last ones may have been on the way";
  frames.note(status_of(10, 7, 6), ended + milliseconds(300));
  frames.note(status_of(20, 6, 6), ended + milliseconds(400));
  EXPECT_FALSE(frames.is_drained()) << "the first one works still";
  frames.note(status_of(10, 7, 7), ended + milliseconds(1300));
  frames.note(status_of(30, 7, 7), ended + milliseconds(1350));
  frames.note(status_of(20, 7, 6), ended + milliseconds(1400));
  EXPECT_FALSE(frames.is_drained());
  status_t skipped = status_of(20, 7, 5);
  skipped.frames_skipped = 1;
  skipped.frames_refused = 1;
  frames.note(skipped, ended + milliseconds(2400));
  EXPECT_TRUE(frames.is_drained());
  frames.note(status_of(20, 8, 7), ended + milliseconds(3400));
  EXPECT_TRUE(frames.is_drained());
}

TEST(DrainMonitor, NobodyIsWaitedForWhereNobodyIs) {
  EXPECT_TRUE(DrainMonitor({}, DrainMonitor::Clock::now()).is_drained());
}

}  // namespace

}  // namespace houghstream::stream
