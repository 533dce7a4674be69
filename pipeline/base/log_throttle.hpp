#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace houghstream {

/// Throttles the log: of each kind of line one a second is admitted, with the number of lines suppressed since the
/// previous one. May be used from any thread.
class LogThrottle {
 public:
  using Clock = std::chrono::steady_clock;

  /// The line as it is to be logged, or nothing. A sender of rubbish may make up kinds without end: from the 64th on
  /// all further ones are one.
  std::optional<std::string> admit(const std::string& kind, const std::string& line, Clock::time_point now);

  /// Returns the number of suppressed lines that no later one has reported yet.
  std::int64_t suppressed() const;

 private:
  struct Kind {
    std::optional<Clock::time_point> last;
    std::int64_t suppressed = 0;
  };

  mutable std::mutex mutex_;
  std::map<std::string, Kind> kinds_;
};

}  // namespace houghstream
