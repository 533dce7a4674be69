#include "pipeline/base/log_line.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(LogLine, WhatIsBelowTheLeastIsLeftOut) {
  testing::internal::CaptureStderr();
  start_log("quiet", LogLevel::kWarning);
  log_debug("one {}", 1);
  log_info("two {}", 2);
  log_warning("three {}", 3);
  log_error("four {:.1f}", 4.0);
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(log.find("one"), std::string::npos);
  EXPECT_EQ(log.find("two"), std::string::npos);
  EXPECT_NE(log.find("quiet: three 3\n"), std::string::npos) << log;
  EXPECT_NE(log.find("quiet: four 4.0\n"), std::string::npos) << log;
}

TEST(LogLine, HushedItSaysErrorsOnlyUnlessAllWasAskedFor) {
  testing::internal::CaptureStderr();
  start_log("hushed", LogLevel::kInfo);
  hush_log();
  log_warning("one");
  log_error("two");
  start_log("asked", LogLevel::kDebug);
  hush_log();
  log_debug("three");
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(log.find("one"), std::string::npos);
  EXPECT_NE(log.find("hushed: two\n"), std::string::npos) << log;
  EXPECT_NE(log.find("asked: three\n"), std::string::npos) << log;
}

TEST(LogLine, BracesInValuesAreNotLookedAt) {
  testing::internal::CaptureStderr();
  start_log("whole", LogLevel::kDebug);
  log_debug("{}", "{} {0}");
  EXPECT_NE(testing::internal::GetCapturedStderr().find("whole: {} {0}\n"), std::string::npos);
}

}  // namespace
}  // namespace houghstream
