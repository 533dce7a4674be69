#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <optional>

#include "pose/reconstruction/map/keyframe_map.hpp"

namespace houghstream::reconstruction {

/// Caches the landmarks of a lost frame, and their match with each keyframe, since the frame is searched repeatedly.
struct LandmarkCache {
  struct KeyframeMatch {
    std::size_t matches = 0;  ///< number of matching landmarks; 0 = no information
    Eigen::Isometry3d T_frame_keyframe = Eigen::Isometry3d::Identity();
  };
  std::optional<Landmarks> landmarks;
  std::map<int, KeyframeMatch> by_keyframe;
};

/// A frame that could not be registered on arrival.
struct LostFrame {
  int number = 0;  ///< number in its take
  RgbdFrame frame;
  LandmarkCache cache;
};

/// Gives the last known pose, from which a lost frame is searched.
struct LastPose {
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();  ///< last known pose, metres
  double max_view_angle = 1e9;  ///< maximum KeyframeMap::view_angle() to that pose, radians
};

/// Registers a frame to the keyframes nearest to the last pose, one after another, each time from the keyframe's own
/// pose.
std::optional<Alignment> relocalise_by_neighbours(const KeyframeMap& map, const FrameLevels& levels,
                                                  const LastPose& last);

/// Relocalises frames by the landmarks that they have in common with keyframes.
class Relocaliser {
 public:
  /// Registers a frame to the keyframe with the most landmarks in common, if these suffice. `cache.landmarks` are the
  /// frame's. Unless `everywhere`, it tries some keyframes only: the nearest, and others in turn from call to call.
  std::optional<Alignment> find(const KeyframeMap& map, const FrameLevels& levels, const LastPose& last,
                                bool everywhere, LandmarkCache& cache);

 private:
  std::size_t next_to_try_ = 0;
};

}  // namespace houghstream::reconstruction
