#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "pipeline/process/detector_count.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

/// The last poses of each camera, from which those of its next frame start (warm start), and the classes that were
/// detected in the last frames. Where several detectors work on one camera's frames, each one's result continues from
/// its own last one. Not thread-safe.
class PoseHistory {
 public:
  /// Notes the classes of a result, before its poses are estimated. Returns those that another detector has found in
  /// this frame before, which get two poses. `arrival_number` distinguishes frames of one frame id (a log that is
  /// played again): results of another number are of another frame.
  std::vector<std::string> note_classes(const Detections& detections, std::int64_t arrival_number);

  /// Returns the last poses of this camera; with several detectors, the last ones of an earlier frame that share a
  /// class with these detections. Empty where there are none.
  ObjectPoses find_warm_start(const Detections& detections) const;

  /// Adds the poses of a result.
  void add(const ObjectPoses& poses);

 private:
  /// Classes that were found in a frame so far, by all its detectors.
  struct FrameClasses {
    FrameId frame;
    std::int64_t number = 0;
    std::set<std::string> names;
  };

  std::map<std::string, std::deque<ObjectPoses>> cameras_;  // by channel name, oldest first
  std::deque<FrameClasses> classes_;                        // classes of the last frames, oldest first
  DetectorCount detectors_;
};

}  // namespace houghstream
