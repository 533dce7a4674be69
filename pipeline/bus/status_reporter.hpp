#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <houghstream/status_t.hpp>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "pipeline/base/log_throttle.hpp"
#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/bus/sequence_tracker.hpp"
#include "pipeline/types/known_objects.hpp"

namespace houghstream {

/// Keeps a process's account of its frames: received = processed + skipped + refused, and one or two in between;
/// sent = received + lost. What comes twice is counted as a duplicate and as nothing else.
/// Every function may be called from any thread.
class StatusReporter {
 public:
  using Clock = std::chrono::steady_clock;

  /// `process` is the executable's name.
  explicit StatusReporter(std::string process);

  void count_received();
  /// Counts a frame that has arrived, by the number of its source; missing numbers count as lost frames
  /// (SequenceTracker). Each source (a camera's channel) is counted separately. A duplicate is to be dropped, and
  /// counts as a duplicate only.
  FrameOrder note_number(const FrameNumber& number, const std::string& source = "");
  /// Counts a duplicate of a message that is not a frame.
  void note_duplicate();
  void count_skipped(std::int64_t frames);
  /// Counts a processed frame; `latency` is from its arrival in this process until its result was published.
  void count_processed(Clock::duration latency);
  /// Counts a frame that could not be processed. The error is stored, and logged: one line a second of each `kind`.
  void count_refused(const std::string& reason, const std::string& kind = "");
  /// Counts another message than a frame that could not be understood, separately from frames.
  void note_bad_message(const std::string& reason);
  /// Stores the last error, which the caller has logged.
  void set_last_error(const std::string& reason);
  /// Sets a function that is called for each status from now on: its result is published beside the status, and a fault
  /// of the store becomes the last error.
  void set_known_objects(std::function<KnownObjects()> objects) { objects_ = std::move(objects); }

  status_t message() const;

  /// Publishes the status, and the known objects where set_known_objects() was called. An outage of the bus that has
  /// ended is stored as the last error. Throws InputError where the bus does not accept it.
  void publish(LcmBus& bus);
  /// Publishes the status if a second has passed since the last time, and returns whether it has.
  bool publish_if_due(LcmBus& bus);
  /// Publishes the status from a thread that must not end on a bus error: logs the error and returns false.
  bool try_publish_if_due(LcmBus& bus);

  /// Returns the account in one line.
  std::string summary() const;

 private:
  void log_throttled(const std::string& kind, const std::string& reason);
  void note_outage(const LcmBus& bus);

  struct Finished {
    Clock::time_point time;
    double latency_ms = 0.0;
  };

  mutable std::mutex mutex_;
  std::string process_;
  std::int64_t received_ = 0;
  std::int64_t processed_ = 0;
  std::int64_t skipped_ = 0;
  std::int64_t refused_ = 0;
  std::int64_t bad_messages_ = 0;
  std::int64_t duplicates_ = 0;
  std::map<std::string, SequenceTracker> sequences_;  // by source name
  std::string last_error_;
  std::string outage_;  // last outage of the bus that was stored as an error
  std::function<KnownObjects()> objects_;
  std::deque<Finished> recent_;  // frames finished within the last few seconds
  Clock::time_point last_published_ = Clock::now();
  LogThrottle complaints_;
};

}  // namespace houghstream
