#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace houghstream {

/// Holds the wall time that one stage spent on a frame. Names are "process.stage", for instance "detect.leaves".
struct StageTime {
  std::string stage;
  std::int64_t duration_us = 0;
};

/// Measures consecutive stages: each `mark` closes the stage that began at the previous one. A stage that comes again
/// adds to its time.
class StageClock {
 public:
  void mark(std::string stage) {
    const auto now = std::chrono::steady_clock::now();
    const auto spent = std::chrono::duration_cast<std::chrono::microseconds>(now - last_).count();
    last_ = now;
    for (StageTime& known : times_) {
      if (known.stage != stage) continue;
      known.duration_us += spent;
      return;
    }
    times_.push_back({std::move(stage), spent});
  }
  const std::vector<StageTime>& times() const { return times_; }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::vector<StageTime> times_;
};

}  // namespace houghstream
