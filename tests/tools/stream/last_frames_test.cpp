#include "tools/stream/last_frames.hpp"

#include <gtest/gtest.h>

namespace houghstream::stream {
namespace {

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
