#include "tools/view/frame_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pipeline/base/checks.hpp"

namespace houghstream::view {

FrameMatcher::FrameMatcher(MatchSettings settings) : settings_(settings) {
  require(settings.rate_hz > 0.0 && settings.rate_hz <= 1000.0, "drawing rate of {} Hz, expected above 0 to 1000",
          settings.rate_hz);
}

void FrameMatcher::add_frame(const FrameId& id, std::vector<std::uint8_t> bytes, std::int64_t now_us) {
  if (!first_arrival_us_) first_arrival_us_ = last_detections_us_ = last_poses_us_ = now_us;
  detectors_.note_frame(id);
  if (const auto known = waiting_.find(id); known != waiting_.end()) forget(known);
  MatchedFrame& frame = waiting_[id];
  frame.id = id;
  frame.bytes = bytes.size();
  frame.frame_bytes = std::move(bytes);
  frame.arrival_us = now_us;
  const double seconds = static_cast<double>(now_us - *first_arrival_us_) * 1e-6;
  frame.slot = static_cast<std::int64_t>(std::floor(seconds * settings_.rate_hz));
  bytes_ += frame.bytes;
  keep_within_bytes();
}

void FrameMatcher::add_detections(Detections detections, std::int64_t now_us, std::size_t bytes) {
  last_detections_us_ = now_us;
  detectors_.note_result(detections.frame);
  MatchedFrame* frame = frame_with_room(detections.frame, bytes);
  if (frame == nullptr) return;
  frame->detect_latency_ms = static_cast<double>(now_us - frame->arrival_us) * 1e-3;
  ++frame->detections_heard;
  frame->results.add(std::move(detections));
  keep_within_bytes();
}

void FrameMatcher::add_poses(ObjectPoses poses, std::int64_t now_us, std::size_t bytes) {
  last_poses_us_ = now_us;
  MatchedFrame* frame = frame_with_room(poses.frame, bytes);
  if (frame == nullptr) return;
  frame->pose_latency_ms = static_cast<double>(now_us - frame->arrival_us) * 1e-3;
  frame->results.add(std::move(poses));
  keep_within_bytes();
}

// The frame that a result is of, unless it has results without end.
MatchedFrame* FrameMatcher::frame_with_room(const FrameId& id, std::size_t bytes) {
  const auto found = waiting_.find(id);
  if (found == waiting_.end() || found->second.bytes + bytes > settings_.kept_bytes) return nullptr;
  found->second.bytes += bytes;
  bytes_ += bytes;
  return &found->second;
}

FrameMatcher::Waiting::iterator FrameMatcher::forget(Waiting::iterator frame) {
  bytes_ -= frame->second.bytes;
  return waiting_.erase(frame);
}

// One frame stays, however large it is.
void FrameMatcher::keep_within_bytes() {
  while (bytes_ > settings_.kept_bytes && waiting_.size() > 1) {
    forget(std::min_element(waiting_.begin(), waiting_.end(),
                            [](const auto& a, const auto& b) { return a.second.arrival_us < b.second.arrival_us; }));
    ++passed_over_;
  }
}

bool FrameMatcher::ready(const MatchedFrame& frame, std::int64_t now_us) const {
  if (frame.results.followed()) return true;
  const std::vector<FrameResult>& results = frame.results.results();
  const bool all_heard = frame.detections_heard >= detectors_.estimate(frame.id.channel);
  if (all_heard && frame.results.has_all_poses()) return true;
  if (now_us - frame.arrival_us < settings_.wait_us) return false;
  const bool posed =
      std::any_of(results.begin(), results.end(), [](const FrameResult& r) { return r.poses.has_value(); });
  const auto silent = [&](std::int64_t last_us) { return now_us - last_us > settings_.silence_us; };
  return posed || silent(results.empty() ? last_detections_us_ : last_poses_us_);
}

std::optional<MatchedFrame> FrameMatcher::next(std::int64_t now_us) {
  for (auto it = waiting_.begin(); it != waiting_.end();) {
    const bool late = it->second.slot <= last_slot_ || now_us - it->second.arrival_us > settings_.kept_us;
    if (late) ++passed_over_;
    it = late ? forget(it) : std::next(it);
  }
  const MatchedFrame* earliest = nullptr;
  for (const auto& [id, frame] : waiting_) {
    if (ready(frame, now_us) && (earliest == nullptr || frame.arrival_us < earliest->arrival_us)) earliest = &frame;
  }
  if (earliest == nullptr) return std::nullopt;
  last_slot_ = earliest->slot;
  const auto found = waiting_.find(earliest->id);
  bytes_ -= found->second.bytes;
  std::optional<MatchedFrame> result = std::move(found->second);
  waiting_.erase(found);
  return result;
}

}  // namespace houghstream::view
