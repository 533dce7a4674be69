#include "pipeline/process/detection_throttle.hpp"

#include "pipeline/types/frame_time.hpp"

namespace houghstream {

bool DetectionThrottle::is_due(const FrameId& frame) {
  constexpr double kExpedited = 0.25;
  constexpr double kSlack = 0.002;  // seconds, for the jitter of times
  if (!(max_rate_hz_ > 0.0)) return true;
  if (cameras_.size() >= kCameras && cameras_.count(frame.channel) == 0) return true;
  Camera& camera = cameras_[frame.channel];
  const double passed_s = seconds_between(camera.last_utime, frame.utime);
  const double wait_s = (camera.is_expedited ? kExpedited : 1.0) / max_rate_hz_;
  const double age_s = seconds_between(camera.first_utime, frame.utime);
  const bool is_start = camera.was_due && age_s >= 0.0 && age_s < start_s_ && passed_s > 0.0;
  if (camera.was_due && !is_start && passed_s >= -kMaxOvertakenS && passed_s + kSlack < wait_s) return false;
  if (!camera.was_due) camera.first_utime = frame.utime;
  camera.was_due = true;
  camera.is_expedited = false;
  camera.last_utime = frame.utime;
  return true;
}

void DetectionThrottle::expedite(const std::string& channel) {
  if (const auto camera = cameras_.find(channel); camera != cameras_.end()) camera->second.is_expedited = true;
}

void DetectionThrottle::note_doubts(const std::string& channel, int doubtful) {
  const auto camera = cameras_.find(channel);
  if (camera == cameras_.end()) return;
  if (doubtful > camera->second.doubtful) camera->second.is_expedited = true;
  camera->second.doubtful = doubtful;
}

}  // namespace houghstream
