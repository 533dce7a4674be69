#include "pipeline/base/host_clock.hpp"

#include <gtest/gtest.h>

#include <ctime>

namespace houghstream {
namespace {

constexpr std::int64_t kSecond = 1'000'000;

TEST(HostClock, NowIsInMicrosecondsSinceTheEpoch) {
  const std::int64_t before = std::time(nullptr);
  const std::int64_t now = utime_now();
  const std::int64_t after = std::time(nullptr);
  EXPECT_GE(now, (before - 1) * kSecond) << "time() may lag behind by a tick";
  EXPECT_LT(now, (after + 2) * kSecond);
}

TEST(HostClock, AMomentOfASteadyClockIsAsLongAgo) {
  const std::int64_t before = utime_now();
  const std::int64_t then = utime_of(std::chrono::steady_clock::now() - std::chrono::hours(1));
  const std::int64_t after = utime_now();
  EXPECT_GE(then, before - 3601 * kSecond);
  EXPECT_LE(then, after - 3599 * kSecond);
}

}  // namespace
}  // namespace houghstream
