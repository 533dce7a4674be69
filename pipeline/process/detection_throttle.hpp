#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// Which frames of each camera a detector looks at that is to look so many times a second. Goes by the frames' own
/// times. Not thread-safe.
class DetectionThrottle {
 public:
  /// Cameras whose looks are remembered; every frame of a further one is looked at. A sender of rubbish may make up
  /// channels without end.
  static constexpr std::size_t kCameras = 64;

  /// 0: at every frame.
  explicit DetectionThrottle(double max_rate_hz) : max_rate_hz_(max_rate_hz) {}

  /// Whether this frame is looked at: where enough time has passed since the camera's last look. Times that go back by
  /// more than a second begin anew; a frame that is older by less has been overtaken on its way.
  bool is_due(const FrameId& frame);

  /// The camera's next look comes after a quarter of the time, once. One that has had no look is left alone: results
  /// may name any camera.
  void expedite(const std::string& channel);

 private:
  struct Camera {
    bool was_due = false;
    bool is_expedited = false;
    std::int64_t last_utime = 0;  // of a look
  };

  double max_rate_hz_;
  std::map<std::string, Camera> cameras_;  // by channel
};

}  // namespace houghstream
