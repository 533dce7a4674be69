#pragma once

#include <functional>
#include <optional>

#include "pipeline/process/pose_process.hpp"

namespace houghstream {

/// Who follows objects from frame to frame. Both functions are called at the same time from two threads on a network,
/// one after the other where a log is worked on.
struct FollowPoses {
  /// Poses of what is followed in the newest frame of a camera; with the frame's stages, that of its decoding the last.
  /// Nothing for a frame that newer ones have overtaken on its way.
  std::function<std::optional<ObjectPoses>(const RgbdFrame&)> follow;
  /// Poses of a frame's detections, which come later; what is found is followed from then on.
  std::function<ObjectPoses(const RgbdFrame&, const Detections&)> answer;
};

/// As run_pose_process, but each frame is worked on as soon as it comes, always the newest of each camera: the poses of
/// the followed objects are published, and a rigid_transform_t for each valid one. Detections, of as many frames as a
/// detector looks at, are answered beside that, by a thread of its own; transforms come from the followed poses only.
/// In its status a frame counts as received when it has come, as skipped when a newer one was there first or was worked
/// on before it. Of a log every event is worked on in its order; it need not hold detections.
void run_follow_process(LcmBus& bus, const PoseProcessOptions& options, const FollowPoses& poses);

}  // namespace houghstream
