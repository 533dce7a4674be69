#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/known_objects.hpp"
#include "pipeline/types/object_pose.hpp"

namespace houghstream {

struct PoseProcessOptions {
  std::string process = "hs-pose";               ///< its name in status_t
  std::string frame_channels = channel::kFrame;  ///< a ChannelPattern: one camera's channel, or several cameras'
  std::optional<Camera> camera;                  ///< for frames that do not bring their own
  bool keep_frames = false;                      ///< of a log: frames and their detections go to the output log too
  std::set<std::string> models;                  ///< classes that have one; where none is detected, it warns
  std::function<KnownObjects()> objects;         ///< what its store holds, for the status; they have models too
};

/// The poses of a frame's detections; the third argument is what was given for this camera's frame before, to start
/// from.
using EstimatePoses = std::function<ObjectPoses(const RgbdFrame&, const Detections&, const ObjectPoses&)>;

/// Receives frames and detections, brings each detections_t together with its own frame (same channel, same time),
/// and publishes `estimate`'s result for each pair, and a rigid_transform_t for each valid pose. Detections of frames
/// on other channels than `frame_channels` are somebody else's.
///
/// Transforms go to <OBJECT>_TO_CAMERA where there is one camera, to <OBJECT>_TO_<CAMERA'S CHANNEL> where the channels
/// are a pattern, and from the moment on when detections of another camera's frames are heard.
///
/// On a network the newest detections of each camera come first, the cameras in turn; each frame is decoded as soon as
/// there is time, also before it is known whether something was detected in it. A log (which must hold frames and
/// detections) is worked on in its order, and a frame without detections is not decoded. In its status a frame counts
/// as received when its detections have come. Throws InputError where none of a log's detections has its frame, and
/// where frames are to be kept without a log; returns as run_process_loop does.
void run_pose_process(LcmBus& bus, const PoseProcessOptions& options, const EstimatePoses& estimate);

}  // namespace houghstream
