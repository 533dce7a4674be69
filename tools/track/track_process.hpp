#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "pipeline/bus/lcm_bus.hpp"
#include "pipeline/messages/channels.hpp"
#include "pipeline/types/camera.hpp"
#include "pipeline/types/known_objects.hpp"
#include "pose/tracks/extrinsic_check.hpp"
#include "pose/tracks/tracker.hpp"
#include "tools/track/world_output.hpp"

namespace houghstream::track {

struct TrackProcessOptions {
  std::string process = "hs-track";
  std::string frame_channels = channel::kFrame;  ///< a ChannelPattern: one camera's channel, or several cameras'
  std::optional<Camera> camera;                  ///< camera of frames that do not bring their own
  std::map<std::string, Eigen::Isometry3d> camera_poses;  ///< poses of static cameras, T_world_camera
  double wait_s = 0.1;                                    ///< a frame waits so long for the transforms about its time
  bool check = false;                                     ///< compares the cameras only; nothing is published
  WorldOutputOptions output;                              ///< additional outputs
  std::function<KnownObjects()> objects;                  ///< objects of its store, for the status
};

/// The models as they are when a frame's turn comes.
using CurrentModels = std::function<std::shared_ptr<const tracks::TrackModels>()>;

/// Receives frames, detections, poses, and transforms of cameras on <CAMERA>_TO_WORLD, and publishes an objects_t for
/// each object_poses_t whose frame is known and whose camera's pose at the frame's time is known. Frames of a camera
/// are processed in their order, none is skipped. Without the pose of any camera the frame of the single camera is the
/// world.
///
/// A log (which must hold frames, detections and poses) is worked on event by event, with its own times: replayed, it
/// gives the same bytes but for the times of stages. Poses whose camera has no known pose, and messages that cannot be
/// understood, are counted in the status and logged once a second. Returns the comparison of the cameras when the
/// process ends.
tracks::ExtrinsicCheck run_track_process(LcmBus& bus, const TrackProcessOptions& options, const CurrentModels& models);

}  // namespace houghstream::track
