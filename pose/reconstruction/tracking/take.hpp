#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/types/frame_id.hpp"
#include "pose/reconstruction/map/keyframe_map.hpp"
#include "pose/reconstruction/map/view_sphere.hpp"
#include "pose/reconstruction/selection/object_selection.hpp"

namespace houghstream::reconstruction {

/// Motion of a take: the camera about the object, the object before a static camera, or a turntable with known masks,
/// which TakeMapper does not process.
enum class Motion : std::uint8_t { kUnknown, kCamera, kObject, kTurntable };

/// Result of the registration of a frame.
struct RegisteredFrame {
  FrameId id;
  bool tracked = false;
  bool is_excluded = false;  ///< blurred or badly exposed: it is not used for the model
  int keyframe = -1;         ///< keyframe relative to which its pose is stored
  Eigen::Isometry3d T_camera_keyframe = Eigen::Isometry3d::Identity();
};

/// Gives a range of frames in which the camera's pose is unknown.
struct LostSpan {
  int from = 0, to = 0;  ///< numbers of frames, both lost
  std::string why;
};

/// A finished take: a recording of an object from many sides, from which its model is reconstructed.
struct Take {
  SelectedObject selected;  ///< object in the first frame
  Motion motion = Motion::kUnknown;
  std::vector<Keyframe> keyframes;
  std::vector<RegisteredFrame> frames;
  std::vector<LostSpan> lost;
  std::optional<LoopClosureError> loop_error;  ///< error of the loop around the object, before it was closed
  ViewCoverage seen{};
  int covered_degrees = 0;             ///< part of a full turn from which it was seen, 0 to 360
  int blurred = 0, badly_exposed = 0;  ///< frames
  double tracking_hz = 0.0;            ///< frames a second that tracking alone takes

  /// Returns T_camera_world of a tracked frame.
  Eigen::Isometry3d pose_of(const RegisteredFrame& frame) const;
};

/// Returns the take's lost spans without frames that have been registered since.
std::vector<LostSpan> find_unrecovered_spans(const Take& take);

}  // namespace houghstream::reconstruction
