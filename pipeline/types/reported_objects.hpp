#pragma once

#include <optional>
#include <vector>

#include "pipeline/types/frame_results.hpp"

namespace houghstream {

/// An object that was found in a frame.
struct ReportedObject {
  int detection_index = -1;            ///< index among the frame's merged detections; -1: followed without one
  std::optional<Detection> detection;  ///< none: followed from frame to frame without a detection
  std::optional<ObjectPose> pose;      ///< or the reason why there is none; empty: its pose was not looked for
};

/// The objects that were found in a frame by all detectors, each once.
struct ReportedObjects {
  FrameId frame;
  /// Detections, strongest first, then the followed objects without one.
  std::vector<ReportedObject> objects;
  std::vector<StageTime> stages;  ///< stages of the frame; several detectors list the same stage, each with its time
};

/// Returns the objects of a frame of which these are the results: a candidate counts where its pose confirms it, and an
/// object that is both detected and followed counts once. Returns nothing where the frame has neither detections nor
/// followed poses.
std::optional<ReportedObjects> report_objects(const FrameResults& results);

}  // namespace houghstream
