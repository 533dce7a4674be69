#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

#include "pose/motion/last_step.hpp"
#include "pose/reconstruction/map/keyframe_map.hpp"
#include "pose/reconstruction/tracking/take.hpp"

namespace houghstream::reconstruction {

/// Registers each frame to a map of keyframes, from a prediction by the frame before.
class FrameFollower {
 public:
  /// Sets the frame of LastStep::T_last, from which corners are tracked; it is unused once the object rotates.
  void set_last(FlowFrame frame) { last_flow_ = std::move(frame); }

  /// Returns the next frame's pose T_camera_world, predicted from that of the frame before by the camera's motion of
  /// the tracked corners, or by repetition of its last motion; none where registration fails or the pose would have
  /// jumped. While the object rotates (`motion`), `flow_frame` is empty.
  std::optional<Alignment> follow(const FlowFrame& flow_frame, const FrameLevels& levels, const LastStep& step,
                                  Motion motion, KeyframeMap& map);

 private:
  Alignment register_to_map(const FrameLevels& levels, const Eigen::Isometry3d& T_start, int coarsest,
                            KeyframeMap& map) const;

  FlowFrame last_flow_;
  std::vector<LandmarkObservation> landmarks_;  ///< tracked corners of `last_flow_`, with their present positions
  double mean_photometric_rms_ = 0.3;
};

}  // namespace houghstream::reconstruction
