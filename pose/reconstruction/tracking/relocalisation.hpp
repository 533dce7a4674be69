#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <optional>

#include "pose/reconstruction/map/keyframe_map.hpp"

namespace houghstream::reconstruction {

/// Caches the corners of a lost frame, and their match with each keyframe, since the frame is searched repeatedly.
struct LandmarkCache {
  struct Place {
    std::size_t corners = 0;  ///< matching corners; 0 = no information
    Eigen::Isometry3d T_frame_keyframe = Eigen::Isometry3d::Identity();
  };
  std::optional<Landmarks> seen;
  std::map<int, Place> by_keyframe;
};

/// A frame that could not be placed when it came.
struct LostFrame {
  int number = 0;  ///< number in its take
  RgbdFrame frame;
  LandmarkCache corners;
};

/// Gives the last known pose, from which a lost frame is searched.
struct LastPlace {
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();  ///< last known pose, metres
  double max_view_angle = 1e9;  ///< maximum KeyframeMap::view_angle() to that pose, radians
};

/// Lays a frame on the keyframes nearest to the last place, one by one, with its view taken for theirs.
std::optional<Alignment> relocalise_by_neighbours(const KeyframeMap& map, const FrameLevels& levels,
                                                  const LastPlace& last);

/// Looks for frames by the corners that they have in common with keyframes.
class Relocaliser {
 public:
  /// Lays a frame on the keyframe with the most corners in common, if these suffice. `corners.seen` are the frame's.
  /// Unless it is to look `everywhere`, it tries some keyframes: the nearest, and others in turn from call to call.
  std::optional<Alignment> find(const KeyframeMap& map, const FrameLevels& levels, const LastPlace& last,
                                bool everywhere, LandmarkCache& corners);

 private:
  std::size_t next_to_try_ = 0;
};

}  // namespace houghstream::reconstruction
