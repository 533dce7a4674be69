#include "pipeline/bus/bus_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "pipeline/base/log_line.hpp"

namespace houghstream {
namespace {

TEST(BusLink, AnOutageIsSaidOnceWhenItBeginsAndOnceWhenItEnds) {
  testing::internal::CaptureStderr();
  start_log("test", LogLevel::kInfo);
  BusLink link("udpm://group");
  const BusLink::Clock::time_point begin;
  EXPECT_TRUE(link.is_up());
  for (int quarter = 0; quarter < 50; ++quarter) {
    link.update("no route", begin + std::chrono::milliseconds(250 * quarter));
    EXPECT_FALSE(link.is_up());
    link.note_unsent();
  }
  EXPECT_EQ(link.last_outage(), "") << "it lasts";
  for (int quarter = 50; quarter < 60; ++quarter) link.update("", begin + std::chrono::milliseconds(250 * quarter));
  EXPECT_TRUE(link.is_up());
  EXPECT_EQ(link.unsent(), 50);
  EXPECT_EQ(link.last_outage(), "the bus could not be reached for 12.5 s, 50 messages were not sent");
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 2) << log;
  EXPECT_NE(log.find("udpm://group: no route; waiting until the bus can be reached"), std::string::npos) << log;
}

TEST(BusLink, EachOutageCountsItsOwnMessages) {
  BusLink link("udpm://group");
  const BusLink::Clock::time_point begin;
  for (int outage = 0; outage < 2; ++outage) {
    link.update("gone", begin);
    for (int i = 0; i <= outage; ++i) link.note_unsent();
    link.update("", begin + std::chrono::seconds(1));
  }
  EXPECT_EQ(link.last_outage(), "the bus could not be reached for 1.0 s, 2 messages were not sent");
  EXPECT_EQ(link.unsent(), 3);
}

}  // namespace
}  // namespace houghstream
