#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// Estimates the number of detectors of each camera: the maximum of results per frame among recent frames. No message
/// names its detector. Not thread-safe.
class DetectorCount {
 public:
  /// Maximum number of cameras whose results are counted, since results may name any camera.
  static constexpr std::size_t kCameras = 64;

  /// Notes a frame. One that comes a second time (a log that is replayed, a source that is started again and stamps as
  /// before) is another frame: its results are counted from 0.
  void note_frame(const FrameId& frame);

  /// Notes a result. It may arrive before its frame.
  void note_result(const FrameId& frame);

  /// Makes results of this frame count from 0.
  void forget(const FrameId& frame);

  /// Returns the estimate, at least 1.
  int estimate(const std::string& channel) const;

 private:
  struct Frame {
    std::int64_t utime = 0;
    int results = 0;
    bool has_arrived = false;
  };
  struct Camera {
    std::deque<Frame> frames;         // the last ones with results
    std::deque<std::int64_t> utimes;  // times of the last frames

    Frame* find(std::int64_t utime);
  };

  Camera* find_or_add_camera(const std::string& channel);

  std::map<std::string, Camera> cameras_;  // by channel name
};

}  // namespace houghstream
