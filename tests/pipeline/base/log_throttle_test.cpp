#include "pipeline/base/log_throttle.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

using std::chrono::milliseconds;

TEST(LogThrottle, OneASecondOfEachKindAndTheOthersAreCounted) {
  LogThrottle lines;
  const LogThrottle::Clock::time_point start{};
  EXPECT_EQ(lines.admit("a", "first", start), "first");
  for (int i = 1; i <= 30; ++i) EXPECT_FALSE(lines.admit("a", "next", start + milliseconds(i)).has_value());
  EXPECT_EQ(lines.admit("b", "other", start + milliseconds(31)), "other");
  EXPECT_EQ(lines.suppressed(), 30);
  EXPECT_EQ(lines.admit("a", "later", start + milliseconds(1000)), "later (and 30 more not shown)");
  EXPECT_EQ(lines.admit("a", "last", start + milliseconds(2000)), "last");
  EXPECT_EQ(lines.suppressed(), 0);
}

TEST(LogThrottle, KindsWithoutEndAreOne) {
  LogThrottle lines;
  int admitted = 0;
  for (int i = 0; i < 1000; ++i) admitted += lines.admit(std::to_string(i), "x", {}).has_value() ? 1 : 0;
  EXPECT_LT(admitted, 70);
  EXPECT_EQ(lines.suppressed(), 1000 - admitted);
}

}  // namespace
}  // namespace houghstream
