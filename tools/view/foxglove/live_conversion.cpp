#include "tools/view/foxglove/live_conversion.hpp"

#include <utility>

#include "pipeline/types/reported_objects.hpp"

namespace houghstream::view {
namespace {

constexpr std::size_t kMaxFrames = 256;          // whose results are kept
constexpr int kUnansweredLimit = 30;             // detections without poses, after which no hs-pose is expected
constexpr std::int64_t kRestart_us = 2'000'000;  // a source that steps back farther has started again

}  // namespace

LiveConversion::LiveConversion(const std::optional<Camera>& camera) : messages_({}), camera_(camera) {}

bool LiveConversion::admit_camera(const std::string& channel) {
  if (shown_.count(channel) == 0 && shown_.size() >= kMaxCameras) return false;
  shown_.try_emplace(channel, 0);
  return true;
}

LiveConversion::Messages LiveConversion::add_frame(const images_t& frame, const std::string& channel) {
  if (!admit_camera(channel)) return {};
  detectors_.note_frame({channel, frame.utime});
  return messages_.convert_frame(frame, channel, camera_);
}

FrameResults* LiveConversion::results_of(const FrameId& frame) {
  if (!admit_camera(frame.channel)) return nullptr;
  while (results_.size() >= kMaxFrames && results_.count(frame) == 0) results_.erase(results_.begin());
  return &results_[frame];
}

bool LiveConversion::is_complete(const FrameId& frame, const FrameResults& results) const {
  const bool has_all = static_cast<int>(results.results().size()) >= detectors_.estimate(frame.channel);
  const bool is_answered = results.has_all_poses() || unanswered_ > kUnansweredLimit;
  return results.followed().has_value() || (has_all && is_answered);
}

LiveConversion::Messages LiveConversion::show(const FrameId& frame, const FrameResults& results) {
  std::int64_t& last = shown_[frame.channel];
  const bool is_old = frame.utime < last && microseconds_between(frame.utime, last) < kRestart_us;
  if (is_old || !is_complete(frame, results)) return {};
  last = frame.utime;
  const std::optional<ReportedObjects> objects = report_objects(results);
  return objects ? messages_.convert_objects(*objects) : Messages();
}

LiveConversion::Messages LiveConversion::add_detections(Detections detections) {
  const FrameId frame = detections.frame;
  FrameResults* results = results_of(frame);
  if (results == nullptr) return {};
  detectors_.note_result(frame);
  results->add(std::move(detections));
  if (unanswered_ <= kUnansweredLimit) ++unanswered_;
  return show(frame, *results);
}

LiveConversion::Messages LiveConversion::add_poses(ObjectPoses poses) {
  const FrameId frame = poses.frame;
  FrameResults* results = results_of(frame);
  if (results == nullptr) return {};
  results->add(std::move(poses));
  unanswered_ = 0;
  return show(frame, *results);
}

LiveConversion::Messages LiveConversion::add_world(const WorldObjects& world) {
  return messages_.convert_world(world, placed_);
}

}  // namespace houghstream::view
