#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

#include "pose/reconstruction/keyframe_map.hpp"
#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

/// T_camera_world of the last frame that was placed, and of the one before it.
struct LastPoses {
  Eigen::Isometry3d T_last = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_before = Eigen::Isometry3d::Identity();
};

/// Lays each frame on a map of keyframes, from where the frame before was.
class FrameFollower {
 public:
  /// The frame of LastPoses::T_last, from which corners are followed; not asked for once the object turns.
  void set_last(FlowFrame frame) { last_flow_ = std::move(frame); }

  /// The next frame's pose, from that of the frame before, whose corners say how the camera moved, or as it went on
  /// until then; none where it does not fit or would have jumped. While the object turns (`motion`), `now` is empty.
  std::optional<Alignment> follow(const FlowFrame& now, const FrameLevels& levels, const LastPoses& poses,
                                  Motion motion, KeyframeMap& map);

 private:
  Alignment lay_on_map(const FrameLevels& levels, const Eigen::Isometry3d& T_start, int coarsest,
                       KeyframeMap& map) const;

  FlowFrame last_flow_;
  std::vector<SeenCorner> corners_;  ///< of it, as the present frame shows them
  double usual_light_rms_ = 0.3;
};

}  // namespace houghstream::reconstruction
