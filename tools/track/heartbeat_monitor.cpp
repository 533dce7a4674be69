#include "tools/track/heartbeat_monitor.hpp"

#include <fmt/format.h>

#include <houghstream/status_t.hpp>
#include <iterator>
#include <optional>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream::track {

void HeartbeatMonitor::on_status(const ReceivedMessage& arrival) {
  try {
    const auto status = decode_message<status_t>(arrival.bytes);
    if (status.process != "hs-detect" && status.process != "hs-pose") return;
    const std::string name = fmt::format("{} (process {})", status.process, status.pid);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (last_.size() < kProcesses || last_.count(name) > 0) last_[name] = steady_us(arrival.time);
  } catch (const InputError&) {
  }
}

std::vector<std::string> HeartbeatMonitor::pop_timed_out(std::int64_t now_us) {
  constexpr std::int64_t kTimeout_us = 3000000;
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> out;
  for (auto it = last_.begin(); it != last_.end();) {
    const bool is_timed_out = now_us - it->second > kTimeout_us;
    if (is_timed_out) out.push_back(it->first);
    it = is_timed_out ? last_.erase(it) : std::next(it);
  }
  return out;
}

void HeartbeatMonitor::log_timed_out(std::int64_t now_us) {
  for (const std::string& name : pop_timed_out(now_us)) {
    const std::string line = name + ": no heartbeat for 3 s; objects that only it detects are no longer updated";
    const auto admitted = throttle_.admit(name, line, std::chrono::steady_clock::now());
    if (admitted) log_warning("{}", *admitted);
  }
}

}  // namespace houghstream::track
