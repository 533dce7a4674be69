#pragma once

#include <chrono>
#include <cstdint>
#include <houghstream/status_t.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace houghstream {

/// When each frame, its detections and its poses arrived, on one clock, and what the processes said last.
class FrameTimes {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// The first arrival counts; utime names the frame.
  void note_frame(std::int64_t utime, Time time);
  void note_detections(std::int64_t utime, Time time);
  void note_poses(std::int64_t utime, Time time);
  void note_status(const status_t& status);

  std::size_t frames() const;

  /// One row for each frame in the order of utimes: utime, t_frame, t_detections, t_poses; seconds since the first
  /// arrival, empty where it has not come.
  std::string csv() const;

  /// `sent`: how many frames were published, where it is known. `start_utime`: the csv's zero, microseconds since the
  /// epoch. Counts, rate, latency percentiles in milliseconds
  /// (detect: frame to detections; pose: detections to poses; total: frame to poses), the last status of each
  /// process, and the account sent = detected + skipped + refused + lost of the process that detects.
  nlohmann::json summary(const std::optional<std::int64_t>& sent) const;

 private:
  struct Row {
    std::optional<Time> frame;
    std::optional<Time> detections;
    std::optional<Time> poses;
  };

  std::vector<double> latencies_ms(std::optional<Time> Row::*from, std::optional<Time> Row::*to) const;
  std::int64_t count(std::optional<Time> Row::*what) const;
  double rate_hz(std::optional<Time> Row::*what) const;
  std::optional<Time> start() const;
  nlohmann::json account(std::int64_t sent) const;

  std::map<std::int64_t, Row> rows_;
  std::map<std::string, status_t> processes_;
};

}  // namespace houghstream
