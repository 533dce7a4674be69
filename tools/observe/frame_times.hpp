#pragma once

#include <chrono>
#include <cstdint>
#include <houghstream/status_t.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// Arrival times of each camera's frames, their detections, their poses and the world's objects after them, on one
/// clock, with the last status of each process.
class FrameTimes {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Notes an arrival. The first one counts: where several detectors work on a camera's frames, that of the first one.
  void note_frame(const FrameId& frame, Time time);
  void note_detections(const FrameId& frame, Time time);
  void note_poses(const FrameId& frame, Time time);
  void note_objects(const FrameId& frame, Time time);
  void note_status(const status_t& status);

  std::size_t frames() const;

  /// Returns one row for each frame in the order of utimes: utime, channel, t_frame, t_detections, t_poses, t_objects;
  /// seconds since the first arrival, empty where it has not come.
  std::string csv() const;

  /// Returns the figures of a run. `sent` is the number of published frames, where it is known. `start_utime` is the
  /// csv's zero, microseconds since the epoch. The summary holds counts, rate, latency percentiles in milliseconds
  /// (detect: frame to detections; pose: detections to poses; total: frame to poses; apart from these: frame to
  /// objects, where hs-track is there), the last status of each process (by name, with the process id where several
  /// have one name), and the account sent = detected + skipped + refused + lost of the process that detects; null
  /// unless there is exactly one.
  nlohmann::json summary(const std::optional<std::int64_t>& sent) const;

 private:
  struct Row {
    std::optional<Time> frame;
    std::optional<Time> detections;
    std::optional<Time> poses;
    std::optional<Time> objects;
  };

  std::vector<double> latencies_ms(std::optional<Time> Row::*from, std::optional<Time> Row::*to) const;
  std::int64_t count(std::optional<Time> Row::*what) const;
  double rate_hz(std::optional<Time> Row::*what) const;
  std::optional<Time> start() const;
  nlohmann::json account(std::int64_t sent) const;

  /// Returns the last status of each process, by its name in the summary.
  std::map<std::string, status_t> named_processes() const;

  std::map<FrameId, Row> rows_;
  std::map<std::pair<std::string, std::int32_t>, status_t> processes_;  // status by name and process id
};

}  // namespace houghstream
