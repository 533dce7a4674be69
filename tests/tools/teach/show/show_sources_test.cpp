#include "tools/teach/show/show_sources.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "pipeline/base/stop_signal.hpp"

namespace houghstream::teach {
namespace {

struct CountedProgress : ShowObserver {
  void progress(const ShowProgress& /*now*/) override { ++heard; }
  int heard = 0;
};

bool interrupt_ends_program() {
  struct sigaction now {};
  sigaction(SIGINT, nullptr, &now);
  return now.sa_handler == SIG_DFL;
}

TEST(CameraTake, EndsWhenEnoughWasSeenAndLetsTheProgramBeInterrupted) {
  catch_stop_signals();
  int taken = 0;
  CountedProgress counted;
  CameraTake take(
      [&]() -> std::optional<RgbdFrame> {
        ++taken;
        return RgbdFrame();
      },
      &counted);
  EXPECT_TRUE(take.next().has_value());
  ShowProgress now;
  now.state = TeachingState::kTracking;
  std::fill_n(now.seen.begin(), 40, true);
  now.frame.utime = 1'000'000;
  take.progress(now);
  EXPECT_TRUE(take.next().has_value());
  EXPECT_FALSE(interrupt_ends_program());
  now.frame.utime = 8'000'000;
  take.progress(now);
  EXPECT_FALSE(take.next().has_value());
  EXPECT_EQ(taken, 2);
  EXPECT_EQ(counted.heard, 2);
  EXPECT_TRUE(interrupt_ends_program());
}

TEST(CameraTake, OnlyCamerasAreLive) {
  for (const char* source : {"openni2", "openni2:#2", "stream:OPENNI_FRAME"}) EXPECT_TRUE(is_live(source)) << source;
  for (const char* source : {"log:take.lcmlog", "bop:take", "bag:take.bag", "take.oni", ""})
    EXPECT_FALSE(is_live(source)) << source;
}

}  // namespace
}  // namespace houghstream::teach
