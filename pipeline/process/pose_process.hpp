#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/types/camera_timing.hpp"
#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"
#include "pipeline/types/known_objects.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pipeline/types/placed_objects.hpp"

namespace houghstream {

/// Frames that are named on objects, by class.
using NamedFrames = std::map<std::string, std::vector<ObjectFrame>>;

struct PoseProcessOptions {
  std::string process = "hs-pose";               ///< its name in status_t
  std::string frame_channels = channel::kFrame;  ///< a ChannelPattern: one camera's channel, or several cameras'
  std::optional<Camera> camera;                  ///< camera of frames that do not bring their own
  bool keep_frames = false;                      ///< for a log: frames and their detections go to the output log too
  std::set<std::string> models;                  ///< classes that have one; where none is detected, it warns
  std::function<KnownObjects()> objects;         ///< objects of its store, for the status; they have models too
  /// Returns the frames that are named on its objects now, by class; empty = there are none.
  std::function<NamedFrames()> frames;
  /// Returns the colours learnt of the camera with this channel; empty = none are.
  std::function<CameraChroma(const std::string&)> camera_colours;
  /// Returns the timing learnt of the camera with this channel; nothing = it is not known.
  std::function<std::optional<CameraTiming>(const std::string&)> camera_timing;
};

/// Estimates the poses of a frame's detections; the third argument holds the poses of this camera's previous frame, as
/// a start.
using EstimatePoses = std::function<ObjectPoses(const RgbdFrame&, const Detections&, const ObjectPoses&)>;

/// Receives frames and detections, matches each detections_t with its own frame (same channel, same time), and
/// publishes `estimate`'s result for each pair, and a rigid_transform_t for each valid pose. Detections of frames
/// on other channels than `frame_channels` are left to other processes.
///
/// Transforms go to <OBJECT>_TO_CAMERA where there is one camera, to <OBJECT>_TO_<CAMERA'S CHANNEL> where the channels
/// are a pattern, and from the moment on when detections of another camera's frames are received. Those of named frames
/// go to <OBJECT>_<FRAME>_TO_CAMERA, or _TO_<CAMERA'S CHANNEL>.
///
/// On a network the newest detections of each camera come first, the cameras in turn; each frame is decoded as soon as
/// there is time, also before it is known whether something was detected in it. A log (which must hold frames and
/// detections) is worked on in its order, and a frame without detections is not decoded. In its status a frame counts
/// as received when its detections have come. Throws InputError where none of a log's detections has its frame, and
/// where frames are to be kept without a log; returns as run_process_loop does.
void run_pose_process(LcmBus& bus, const PoseProcessOptions& options, const EstimatePoses& estimate);

/// Returns the poses of the objects followed in a camera's newest frame, or nothing for an overtaken frame. Their
/// stages are the frame's, decoding last.
using FollowFrame = std::function<std::optional<ObjectPoses>(const RgbdFrame&)>;

/// Functions that follow objects from frame to frame. Both are called concurrently from two threads on a network, one
/// after the other where a log is processed.
struct FollowPoses {
  FollowFrame follow;
  /// Poses of a frame's detections, which come later; what is found is followed from then on.
  std::function<ObjectPoses(const RgbdFrame&, const Detections&)> process_detections;
};

/// Works as run_pose_process, but each frame is processed as soon as it comes, always the newest of each camera: the
/// poses of the followed objects are published, and a rigid_transform_t for each valid one. Detections, which may be of
/// a part of the frames, are processed by another thread meanwhile; transforms come from the followed poses only. In
/// its status a frame counts as received when it has come, as skipped when a newer one was there first or was processed
/// before it. Every event of a log is processed in order; the log need not hold detections.
void run_follow_process(LcmBus& bus, const PoseProcessOptions& options, const FollowPoses& poses);

}  // namespace houghstream
