#pragma once

#include <functional>
#include <optional>
#include <string>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

struct PoseProcessOptions {
  std::string process = "hs-pose";  ///< its name in status_t
  std::string frame_channel = "OPENNI_FRAME";
  std::optional<Camera> camera;  ///< for frames that do not bring their own
};

/// Receives frames and detections, pairs each detections_t with its own frame, and publishes `estimate`'s result for
/// each pair, and a rigid_transform_t for each valid pose. Only frames in which something was detected are decoded.
/// On a network the newest detections come first; in a log (which must hold frames and detections) every one is
/// worked on. In its status a frame counts as received when its detections have come. Returns as run_process_loop
/// does.
void run_pose_process(LcmBus& bus, const PoseProcessOptions& options,
                      const std::function<ObjectPoses(const RgbdFrame&, const Detections&)>& estimate);

}  // namespace houghstream
