#include "pipeline/process/detection_throttle.hpp"

#include "pipeline/types/frame_time.hpp"

namespace houghstream {

bool DetectionThrottle::is_due(const FrameId& frame) {
  constexpr double kExpedited = 0.25;
  constexpr double kSlack = 0.002;  // seconds, for times that tremble
  if (!(max_rate_hz_ > 0.0)) return true;
  if (cameras_.size() >= kCameras && cameras_.count(frame.channel) == 0) return true;
  Camera& camera = cameras_[frame.channel];
  const double passed_s = seconds_between(camera.last_utime, frame.utime);
  const double wait_s = (camera.is_expedited ? kExpedited : 1.0) / max_rate_hz_;
  if (camera.was_due && passed_s >= -kMaxOvertakenS && passed_s + kSlack < wait_s) return false;
  camera = {true, false, frame.utime};
  return true;
}

void DetectionThrottle::expedite(const std::string& channel) {
  if (const auto camera = cameras_.find(channel); camera != cameras_.end()) camera->second.is_expedited = true;
}

}  // namespace houghstream
