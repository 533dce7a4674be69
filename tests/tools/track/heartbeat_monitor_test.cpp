#include "tools/track/heartbeat_monitor.hpp"

#include <gtest/gtest.h>

#include <houghstream/status_t.hpp>

#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream::track {
namespace {

/// Receives a status at a time of the steady clock, while the host's is being set back.
void hear_of(HeartbeatMonitor& silence, const std::string& process, std::int64_t time_us) {
  status_t status{};
  status.process = process;
  status.pid = 7;
  const std::vector<std::uint8_t> bytes = encode_message(status);
  const std::chrono::steady_clock::time_point time{std::chrono::microseconds(time_us)};
  const std::int64_t set_back_us = -time_us;
  silence.on_status({channel::kStatus, {bytes.data(), bytes.size()}, time, set_back_us});
}

TEST(HeartbeatMonitor, IsToldOnceOfWhoFindsObjects) {
  HeartbeatMonitor silence;
  hear_of(silence, "hs-detect", 1000000);
  hear_of(silence, "hs-pose", 3000000);
  hear_of(silence, "hs-view", 1000000);
  EXPECT_TRUE(silence.pop_timed_out(4000000).empty());
  EXPECT_EQ(silence.pop_timed_out(4000001), std::vector<std::string>{"hs-detect (process 7)"});
  EXPECT_TRUE(silence.pop_timed_out(4000001).empty());
  hear_of(silence, "hs-detect", 5000000);
  EXPECT_EQ(silence.pop_timed_out(9000000).size(), 2U);
}

TEST(HeartbeatMonitor, HearsNothingOfWhatIsNoStatus) {
  HeartbeatMonitor silence;
  const std::vector<std::uint8_t> rubbish(100, 1);
  silence.on_status({channel::kStatus, {rubbish.data(), rubbish.size()}, {}, 1});
  EXPECT_TRUE(silence.pop_timed_out(9000000).empty());
}

}  // namespace
}  // namespace houghstream::track
