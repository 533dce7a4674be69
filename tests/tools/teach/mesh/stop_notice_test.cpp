#include "tools/teach/mesh/stop_notice.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

namespace houghstream::teach {
namespace {

void wait_a_second() {
  for (int i = 0; i < 100; ++i) usleep(10'000);
}

TEST(StopNoticeDeathTest, SaysWhatIsLeftAndEndsByTheSignal) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  for (const int signal : {SIGINT, SIGTERM}) {
    EXPECT_EXIT(
        {
          const StopNotice notice("stopped; all is as it was");
          kill(getpid(), signal);
          wait_a_second();
        },
        testing::KilledBySignal(signal), "^stopped; all is as it was\n$");
  }
}

TEST(StopNoticeDeathTest, WhatWasBegunIsRemoved) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const std::filesystem::path begun = std::filesystem::temp_directory_path() / "stop_notice_test.begun";
  std::filesystem::create_directories(begun / "views");
  EXPECT_EXIT(
      {
        StopNotice notice("stopped");
        notice.remove_on_stop(begun);
        kill(getpid(), SIGINT);
        wait_a_second();
      },
      testing::KilledBySignal(SIGINT), "^stopped\n$");
  EXPECT_FALSE(std::filesystem::exists(begun));
}

TEST(StopNoticeDeathTest, AfterItsReleaseASignalWaitsWithoutAWord) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        {
          StopNotice notice("stopped; all is as it was");
          notice.release();
          kill(getpid(), SIGINT);
          wait_a_second();
          std::fprintf(stderr, "exchanged");
        }
        wait_a_second();
      },
      testing::KilledBySignal(SIGINT), "^exchanged$");
}

}  // namespace
}  // namespace houghstream::teach
