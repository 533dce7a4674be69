#include "tools/doctor/lcm_probe.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <houghstream/status_t.hpp>
#include <vector>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/wire_check.hpp"

namespace houghstream::doctor {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

/// Handles messages until `done` or the time is over.
template <typename Done>
void handle_until(LcmBus& bus, milliseconds time, const Done& done) {
  const Clock::time_point end = Clock::now() + time;
  while (!done() && Clock::now() < end) bus.handle(milliseconds(20));
}

}  // namespace

std::size_t heard_bytes(const std::string& url, const std::string& channel) {
  std::size_t largest = 0;
  try {
    LcmBus bus(url, "", Existing::kReplaced, AtStart::kFail);
    bus.subscribe(channel, [&](const Arrival& arrival) { largest = std::max(largest, arrival.bytes.size); });
    handle_until(bus, milliseconds(1000), [] { return false; });
  } catch (const std::exception&) {
    return 0;  // the self test says what is wrong with the bus
  }
  return largest;
}

std::set<std::string> heard_frame_channels(const std::string& url) {
  constexpr std::size_t kMaxChannels = 64;  // a sender of rubbish may make up names without end
  std::set<std::string> channels;
  try {
    LcmBus bus(url, "", Existing::kReplaced, AtStart::kFail);
    bus.subscribe(".*", [&](const Arrival& arrival) {
      if (is_frame_message(arrival.bytes) && channels.size() < kMaxChannels) channels.insert(arrival.channel);
    });
    handle_until(bus, milliseconds(1500), [] { return false; });
  } catch (const std::exception&) {
    return {};  // the self test says what is wrong with the bus
  }
  return channels;
}

std::map<std::string, std::string> heard_errors(const std::string& url) {
  constexpr std::size_t kMostProcesses = 64;  // a sender of rubbish may make up names without end
  std::map<std::string, std::string> errors;
  try {
    LcmBus bus(url, "", Existing::kReplaced, AtStart::kFail);
    bus.subscribe(channel::kStatus, [&](const Arrival& arrival) {
      const auto status = decode_message<status_t>(arrival.bytes);
      const bool is_known = errors.count(status.process) > 0 || errors.size() < kMostProcesses;
      if (!status.last_error.empty() && is_known) errors[status.process] = status.last_error;
    });
    handle_until(bus, milliseconds(1500), [] { return false; });
  } catch (const std::exception&) {
    return {};  // the self test says what is wrong with the bus
  }
  return errors;
}

SelfTest self_test(const std::string& url, std::size_t bytes) {
  constexpr int kMessages = 5;
  SelfTest result;
  try {
    LcmBus bus(url, "", Existing::kReplaced, AtStart::kFail);
    std::vector<std::uint8_t> message(bytes);
    bool came = false;
    // Another doctor may be at work on the same bus.
    const std::string channel = "HOUGHSTREAM_SELF_TEST_" + std::to_string(getpid());
    bus.subscribe(channel, [&](const Arrival& arrival) {
      came = came ||
             std::equal(message.begin(), message.end(), arrival.bytes.data, arrival.bytes.data + arrival.bytes.size);
    });
    for (; result.sent < kMessages; ++result.sent) {
      for (std::size_t i = 0; i < bytes; ++i) message[i] = static_cast<std::uint8_t>(i * 31 + i / 251 + result.sent);
      came = false;
      bus.publish(channel, {message.data(), message.size()}, 0);
      handle_until(bus, milliseconds(500), [&] { return came; });
      if (came) ++result.received;
    }
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  return result;
}

}  // namespace houghstream::doctor
