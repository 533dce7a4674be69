#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

#include "pipeline/types/frame_id.hpp"

namespace houghstream {

/// How many detectors work on each camera's frames: as many as one frame had results of late. No message names its
/// detector. Not thread-safe.
class DetectorCount {
 public:
  /// Cameras whose results are counted; of a further one nothing is known. Results may name any camera.
  static constexpr std::size_t kCameras = 64;

  void note_result(const FrameId& frame);

  /// The frame has come again (a log that is replayed): results of it are counted anew.
  void forget(const FrameId& frame);

  /// At least 1.
  int of(const std::string& channel) const;

 private:
  struct Frame {
    std::int64_t utime = 0;
    int results = 0;
  };
  std::map<std::string, std::deque<Frame>> cameras_;  // by channel, the last frames with results
};

}  // namespace houghstream
