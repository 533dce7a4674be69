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

/// The frame that objects are given in, and where cameras are in it: the world, or, as long as the place of no camera
/// is known, the frame of the one camera. Transforms may be added from any thread; all else is for the thread that
/// works on the frames.
class WorldReference {
 public:
  /// `fixed`: cameras that stand still, T_world_camera by the channels of their frames.
  explicit WorldReference(const std::map<std::string, Eigen::Isometry3d>& fixed);

  /// A transform of a camera that moves, as CameraExtrinsics::add() takes it. Throws InputError for one camera too
  /// many.
  void add(const std::string& camera, std::int64_t utime, const Eigen::Isometry3d& T_world_camera);

  /// Where the frame's camera was; `may_come` only while it is worth waiting, for the `may_wait`. Where the place is
  /// one in another world than the last, that begins.
  tracks::CameraPose camera_pose(const FrameId& frame, bool may_wait);

  /// "WORLD", or the channel of the camera whose frame it is; empty until a place was known.
  const std::string& name() const { return name_; }

  /// Whether a world has begun after another one since the last call: nothing seen before has a place in it.
  bool consume_reset() { return std::exchange(begun_, false); }

 private:
  tracks::CameraPose begin(const std::string& world, const tracks::CameraPose& place);

  std::string name_;
  std::string reference_camera_;  // the camera whose frame is the world, where no place is known
  bool begun_ = false;
  std::mutex mutex_;  // of what follows
  tracks::CameraExtrinsics extrinsics_;
};

}  // namespace houghstream::track
