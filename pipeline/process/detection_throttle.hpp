#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// Limits the rate at which a detector searches each camera's frames, by the frames' times. Not thread-safe.
class DetectionThrottle {
 public:
  /// Maximum number of cameras with a stored time; every frame of a further one is processed. An untrusted sender
  /// may make up channels without end.
  static constexpr std::size_t kCameras = 64;

  /// With 0 it detects in every frame. Every frame of a camera's first `start_s` seconds is searched: nothing is
  /// followed yet, and what is not found in one frame may be found in the next.
  explicit DetectionThrottle(double max_rate_hz, double start_s = 0.5) : max_rate_hz_(max_rate_hz), start_s_(start_s) {}

  /// Returns whether this frame is searched: enough time has passed since the camera's last detection. Times that go
  /// back by more than a second restart the interval; a frame that is older by less was overtaken in transit.
  bool is_due(const FrameId& frame);

  /// Shortens the camera's next interval to a quarter, once. Cameras without a detection yet are left alone, since
  /// results may name any camera.
  void expedite(const std::string& channel);

  /// Reports the number of doubtful followed poses of a camera (quality below 0.5). If it has grown, the next interval
  /// is shortened as by expedite(); poses that stay doubtful, such as those of an object without colours, have no
  /// effect.
  void note_doubts(const std::string& channel, int doubtful);

 private:
  struct Camera {
    bool was_due = false;
    bool is_expedited = false;
    int doubtful = 0;
    std::int64_t last_utime = 0;   // time of the last detection
    std::int64_t first_utime = 0;  // time of the first detection
  };

  double max_rate_hz_;
  double start_s_;
  std::map<std::string, Camera> cameras_;  // by channel name
};

}  // namespace houghstream
