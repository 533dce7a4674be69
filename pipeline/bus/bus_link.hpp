#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace houghstream {

/// Tracks the state of the link to a bus: whether it can be reached, since when it cannot, and how many messages could
/// not be sent. Logs one line when an outage begins and one when it ends. May be used from any thread.
class BusLink {
 public:
  using Clock = std::chrono::steady_clock;

  /// `url` names the bus in the log.
  explicit BusLink(std::string url) : url_(std::move(url)) {}

  /// `fault` says why the bus cannot be reached; it is empty where the bus can be reached.
  void update(const std::string& fault, Clock::time_point now);

  /// A message was not sent.
  void note_unsent() { ++unsent_; }

  bool is_up() const { return is_up_; }
  std::int64_t unsent() const { return unsent_; }

  /// Describes the last outage that has ended; empty before the first one.
  std::string last_outage() const;

 private:
  std::string url_;
  mutable std::mutex mutex_;
  std::atomic<bool> is_up_{true};
  std::atomic<std::int64_t> unsent_{0};
  std::int64_t unsent_before_ = 0;  // count when the outage began
  Clock::time_point since_;         // beginning of the outage
  std::string last_outage_;
};

}  // namespace houghstream
