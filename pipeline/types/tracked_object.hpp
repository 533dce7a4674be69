#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/types/frame_id.hpp"
#include "pipeline/types/stage_time.hpp"

namespace houghstream {

/// Visibility of a tracked object in the last frame. Values are those of tracked_object_t.
enum class TrackState : std::int8_t {
  kInvalid = 0,
  kVisible = 1,       ///< a pose of it was measured, or no camera has looked there since
  kUnrecognised = 2,  ///< no pose was measured, but the depth where it stands is as it should be
  kHidden = 3,        ///< occluded by a nearer surface
  kOutOfView = 4,     ///< no camera looks there, or none measures depth there
  kGone = 5           ///< it is not there any more
};

/// Returns one word for people.
const char* to_string(TrackState state);

using Covariance6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Describes one object of the world.
struct TrackedObject {
  std::int64_t track_id = 0;  ///< 1 or more
  int class_id = 0;
  std::string class_name;
  TrackState state = TrackState::kInvalid;
  float probability = 0.0F;  ///< probability that it is at its published pose, 0 to 1
  bool moving = false;       ///< then the pose is filtered with the velocity, else averaged
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();  ///< metres
  Covariance6 covariance = Covariance6::Zero();  ///< translation, m^2, then rotation, rad^2, along and about world axes
  Vector6 velocity = Vector6::Zero();            ///< m/s, then rad/s, along and about world axes; 0 while it stands
  int seen = 0;                                  ///< frames with a pose of it
  std::int64_t first_utime = 0;                  ///< time of its first observation, microseconds since the epoch
  FrameId last_seen;                             ///< frame with its last pose
  std::string reason;                            ///< why it is in this state, one line for people
};

/// Holds all objects of the world after a frame, by track_id.
struct WorldObjects {
  FrameId frame;      ///< after which the world is so
  std::string world;  ///< coordinate frame: "WORLD", or a camera's channel
  int world_number = 1;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< camera pose at the time of the frame
  std::vector<TrackedObject> objects;
  std::vector<StageTime> stages;
};

}  // namespace houghstream
