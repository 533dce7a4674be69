#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

#include "pose/motion/last_step.hpp"
#include "pose/reconstruction/map/keyframe_map.hpp"
#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

/// Lays each frame on a map of keyframes, from where the frame before was.
class FrameFollower {
 public:
  /// The frame of LastStep::T_last, from which corners are followed; not asked for once the object turns.
  void set_last(FlowFrame frame) { last_flow_ = std::move(frame); }

  /// The next frame's pose T_camera_world, from that of the frame before, whose corners say how the camera moved, or as
  /// it went on until then; none where it does not fit or would have jumped. While the object turns (`motion`), `now`
  /// is empty.
  std::optional<Alignment> follow(const FlowFrame& now, const FrameLevels& levels, const LastStep& step, Motion motion,
                                  KeyframeMap& map);

 private:
  Alignment register_to_map(const FrameLevels& levels, const Eigen::Isometry3d& T_start, int coarsest,
                            KeyframeMap& map) const;

  FlowFrame last_flow_;
  std::vector<LandmarkObservation>
      corners_;  ///< corners of `last_flow_` in the world frame, as the present frame shows them
  double usual_light_rms_ = 0.3;
};

}  // namespace houghstream::reconstruction
