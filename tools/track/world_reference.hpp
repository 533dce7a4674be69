#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "pipeline/types/frame_id.hpp"
#include "pose/tracks/camera_extrinsics.hpp"

namespace houghstream::track {

/// Determines the reference frame of the objects, and the cameras' poses in it: the world, or, as long as no camera's
/// pose is known, the frame of the single camera. Transforms may be added from any thread; all else is for the thread
/// that processes the frames.
class WorldReference {
 public:
  /// `fixed` holds the poses of static cameras, T_world_camera by the channels of their frames.
  explicit WorldReference(const std::map<std::string, Eigen::Isometry3d>& fixed);

  /// Adds a transform of a moving camera, see CameraExtrinsics::add_transform(). Throws InputError for one camera too
  /// many.
  void add(const std::string& camera, std::int64_t utime, const Eigen::Isometry3d& T_world_camera);

  /// Returns the pose of the frame's camera; `may_come` is set only where `may_wait` and a transform may still arrive.
  /// A pose in another world than the last one resets the world.
  tracks::CameraPose camera_pose(const FrameId& frame, bool may_wait);

  /// Returns "WORLD", or the channel of the camera whose frame it is; empty until a pose of a camera was known.
  const std::string& name() const { return name_; }

  /// Returns whether the world was reset since the last call: earlier observations have no pose in it.
  bool consume_reset() { return std::exchange(was_reset_, false); }

 private:
  tracks::CameraPose set_world(const std::string& world, const tracks::CameraPose& pose);

  std::string name_;
  std::string reference_camera_;  // the camera whose frame is the world as long as no pose is known
  bool was_reset_ = false;
  std::mutex mutex_;  // guards the following members
  tracks::CameraExtrinsics extrinsics_;
};

}  // namespace houghstream::track
