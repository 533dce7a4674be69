#include "tools/observe/frame_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/base/host_clock.hpp"
#include "pipeline/bus/percentiles.hpp"
#include "tools/common/rounded.hpp"

namespace houghstream {
namespace {

using nlohmann::json;

const std::string kDetector = "hs-detect";

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

// JSON has no NaN.
json number(double value) {
  return std::isfinite(value) ? json(rounded(value, 3)) : json(nullptr);
}

json to_json(const Percentiles& latency) {
  return {{"p50", number(latency.p50)}, {"p95", number(latency.p95)}, {"p99", number(latency.p99)}};
}

json to_json(const status_t& status) {
  return {{"pid", status.pid},
          {"rate_hz", number(status.rate_hz)},
          {"received", status.frames_received},
          {"processed", status.frames_processed},
          {"skipped", status.frames_skipped},
          {"lost", status.frames_lost < 0 ? json(nullptr) : json(status.frames_lost)},
          {"refused", status.frames_refused},
          {"latency_ms", to_json(Percentiles{status.latency_p50_ms, status.latency_p95_ms, status.latency_p99_ms})},
          {"last_error", status.last_error}};
}

json utime_if_any(const std::optional<FrameTimes::Time>& time) {
  return time ? json(utime_of(*time)) : json(nullptr);
}

}  // namespace

void FrameTimes::note_frame(const FrameId& frame, Time time) {
  rows_[frame].frame = rows_[frame].frame.value_or(time);
}

void FrameTimes::note_detections(const FrameId& frame, Time time) {
  rows_[frame].detections = rows_[frame].detections.value_or(time);
}

void FrameTimes::note_poses(const FrameId& frame, Time time) {
  rows_[frame].poses = rows_[frame].poses.value_or(time);
}

void FrameTimes::note_objects(const FrameId& frame, Time time) {
  rows_[frame].objects = rows_[frame].objects.value_or(time);
}

void FrameTimes::note_status(const status_t& status) {
  constexpr std::size_t kMax = 64;  // limit, since a faulty sender may invent names without end
  const std::pair<std::string, std::int32_t> key(status.process, status.pid);
  if (processes_.size() < kMax || processes_.count(key) > 0) processes_[key] = status;
}

std::size_t FrameTimes::frames() const {
  return static_cast<std::size_t>(count(&Row::frame));
}

std::optional<FrameTimes::Time> FrameTimes::start() const {
  std::optional<Time> first;
  for (const auto& [id, row] : rows_) {
    for (const auto& time : {row.frame, row.detections, row.poses, row.objects}) {
      if (time) first = std::min(first.value_or(*time), *time);
    }
  }
  return first;
}

std::string FrameTimes::csv() const {
  const std::optional<Time> zero = start();
  const auto cell = [&](const std::optional<Time>& time) {
    return time ? fmt::format("{:.6f}", seconds(*time - *zero)) : std::string();
  };
  std::string text = "utime,channel,t_frame,t_detections,t_poses,t_objects\n";
  for (const auto& [id, row] : rows_) {
    text += fmt::format("{},{},{},{},{},{}\n", id.utime, id.channel, cell(row.frame), cell(row.detections),
                        cell(row.poses), cell(row.objects));
  }
  return text;
}

std::vector<double> FrameTimes::latencies_ms(std::optional<Time> Row::*from, std::optional<Time> Row::*to) const {
  std::vector<double> latencies;
  for (const auto& [id, row] : rows_) {
    // Poses of followed objects come before the detections.
    if (row.*from && row.*to && *(row.*from) <= *(row.*to))
      latencies.push_back(seconds(*(row.*to) - *(row.*from)) * 1e3);
  }
  return latencies;
}

std::int64_t FrameTimes::count(std::optional<Time> Row::*what) const {
  return std::count_if(rows_.begin(), rows_.end(), [&](const auto& entry) { return (entry.second.*what).has_value(); });
}

double FrameTimes::rate_hz(std::optional<Time> Row::*what) const {
  std::vector<Time> times;
  for (const auto& [id, row] : rows_) {
    if (row.*what) times.push_back(*(row.*what));
  }
  if (times.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  return static_cast<double>(times.size() - 1) / seconds(*last - *first);
}

std::map<std::string, status_t> FrameTimes::named_processes() const {
  std::map<std::string, int> count;
  for (const auto& [key, status] : processes_) ++count[key.first];
  std::map<std::string, status_t> named;
  for (const auto& [key, status] : processes_) {
    named[count[key.first] == 1 ? key.first : fmt::format("{} {}", key.first, key.second)] = status;
  }
  return named;
}

json FrameTimes::account(std::int64_t sent) const {
  const std::map<std::string, status_t> named = named_processes();
  const auto found = named.find(kDetector);
  if (found == named.end()) return nullptr;
  const status_t& detector = found->second;
  const std::int64_t lost = sent - detector.frames_received;
  const std::int64_t unaccounted =
      detector.frames_received - detector.frames_processed - detector.frames_skipped - detector.frames_refused;
  return {{"sent", sent},
          {"detected", detector.frames_processed},
          {"skipped", detector.frames_skipped},
          {"refused", detector.frames_refused},
          {"lost", lost},
          {"unaccounted", unaccounted},
          {"balanced", unaccounted == 0 && lost >= 0}};
}

json FrameTimes::summary(const std::optional<std::int64_t>& sent) const {
  json processes = json::object();
  for (const auto& [name, status] : named_processes()) processes[name] = to_json(status);
  return {{"start_utime", utime_if_any(start())},
          {"frames_sent", sent ? json(*sent) : json(nullptr)},
          {"frames_received", count(&Row::frame)},
          {"frames_detected", count(&Row::detections)},
          {"frames_with_poses", count(&Row::poses)},
          {"frames_with_objects", count(&Row::objects)},
          {"frame_rate_hz", number(rate_hz(&Row::frame))},
          {"detection_rate_hz", number(rate_hz(&Row::detections))},
          {"latency_ms",
           {{"detect", to_json(percentiles(latencies_ms(&Row::frame, &Row::detections)))},
            {"pose", to_json(percentiles(latencies_ms(&Row::detections, &Row::poses)))},
            {"total", to_json(percentiles(latencies_ms(&Row::frame, &Row::poses)))}}},
          {"objects_latency_ms", to_json(percentiles(latencies_ms(&Row::frame, &Row::objects)))},
          {"account", account(sent.value_or(count(&Row::frame)))},
          {"processes", processes}};
}

}  // namespace houghstream
