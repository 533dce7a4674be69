#pragma once

#include <deque>
#include <map>
#include <string>

#include "pipeline/process/detector_count.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

/// The last poses of each camera, from which those of its next frame start (warm start). Where several detectors work
/// on one camera's frames, each one's result goes on from its own last one. Not thread-safe.
class PoseHistory {
 public:
  /// The poses that were kept last for this camera; with several detectors, the last ones of an earlier frame that
  /// share a class with these detections. Empty where there are none.
  ObjectPoses before(const Detections& detections) const;

  void keep(const ObjectPoses& poses);

  /// Another frame of that name has come (DetectorCount).
  void note_again(const FrameId& frame) { detectors_.forget(frame); }

 private:
  std::map<std::string, std::deque<ObjectPoses>> cameras_;  // by channel, oldest first
  DetectorCount detectors_;
};

}  // namespace houghstream
