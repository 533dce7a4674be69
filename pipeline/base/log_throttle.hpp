#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace houghstream {

/// Keeps a flood out of the log: of each kind of line one a second is admitted, and says how many were held back since
/// the one before. May be used from any thread.
class LogThrottle {
 public:
  using Clock = std::chrono::steady_clock;

  /// The line as it is to be logged, or nothing. A sender of rubbish may make up kinds without end: from the 64th on
  /// all further ones are one.
  std::optional<std::string> admit(const std::string& kind, const std::string& line, Clock::time_point now);

  /// Lines that no later one has told of yet.
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
