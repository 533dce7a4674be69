#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/types/chroma_map.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame_id.hpp"
#include "pipeline/types/stage_time.hpp"

namespace houghstream {

/// Status of a pose: valid, or the reason why there is none. Values are those of object_pose_t.
enum class PoseStatus : std::int8_t {
  kInvalid = 0,  ///< not decided
  kValid = 1,
  kNoModel = 2,            ///< the class has no 3-D model
  kTooFewPoints = 3,       ///< hardly any depth inside the box
  kNoInitialPose = 4,      ///< the votes carry no rotation, or the detection no finite centre
  kNotConverged = 5,       ///< no candidate registered
  kRejectedByDepth = 6,    ///< the rendered model contradicts the measured depth
  kLowScore = 7,           ///< hardly an object: its pose was not looked for, or is not believed
  kRejectedByOutline = 8,  ///< the measured surface continues where the model ends
  kRejectedByColour = 9,   ///< the model's colours do not explain those that are seen
  kOccluded = 10,          ///< followed, and mostly hidden by what was measured in front of it
  /// With its best pose it is not probable enough (0.65) that the object is there, or a more probable pose explains its
  /// surface.
  kRefuted = 11,
  kValidUpToSymmetry =
      12,  ///< a pose, of which the texture does not tell that it is not one that looks alike by its shape
};

/// Returns whether a pose of this status is published.
constexpr bool has_pose(PoseStatus status) {
  return status == PoseStatus::kValid || status == PoseStatus::kValidUpToSymmetry;
}

/// Returns one line per status for logs and reports.
const char* to_string(PoseStatus status);

/// Where and when the pose of a weak detection (Detection::reported is false) was searched and rejected.
struct RejectedSearch {
  Eigen::Vector3f centre_camera = Eigen::Vector3f::Zero();  ///< detected centre, camera frame, metres
  std::int64_t utime = 0;                                   ///< time of the frame that was searched
};

/// The pose of one detection with its evidence, or the reason why there is none.
struct ObjectPose {
  int class_id = 0;
  std::string class_name;
  float detection_score = 0.0F;
  int detection_index = -1;  ///< index in the Detections of the result; -1: followed without one
  PoseStatus status = PoseStatus::kInvalid;
  std::optional<Eigen::Isometry3d> T_camera_object;  ///< present exactly when has_pose(status)
  bool converged = false;
  int iterations = 0;
  int inliers = 0;
  float inlier_fraction = 0.0F;
  float residual = 0.0F;              ///< root mean square distance of inliers to the model, metres; NaN if none
  float visible_fraction = 0.0F;      ///< rendered pixels that agree with the measured depth, 0 to 1
  float quality = 0.0F;               ///< probability that the pose is right, 0 to 1; 0 where none was found
  float shape_quality = 0.0F;         ///< the same up to the symmetries of the shape: never below `quality`
  float free_space_violation = 0.0F;  ///< rendered pixels in front of what was measured, 0 to 1
  std::optional<ChromaPair> chroma;   ///< chroma of the model and as measured; not published
  /// Number of consecutive frames up to this one in which the pose continued another one without a search among its
  /// alternatives; not published.
  int continued_frames = 0;
  /// Of a weak detection without a pose: the search that its status is of, in this frame or an earlier one; not
  /// published.
  std::optional<RejectedSearch> rejected_search;
  ChromaMap camera_colours;  ///< map applied to the model's colours, learnt without it; not published
};

/// Returns whether the object counts as found: its detection is above the threshold and not refuted by its pose, or it
/// is a candidate whose pose is valid. `pose` is that of the detection; null where there is none.
bool is_reported(const Detection& detection, const ObjectPose* pose);

/// Holds the poses of one detector's detections in one frame, in their order.
struct ObjectPoses {
  FrameId frame;  ///< frame of the detections
  std::vector<ObjectPose> poses;
  std::vector<StageTime> stages;
};

/// Returns the pose of a detection; null where there is none.
const ObjectPose* find_pose(const ObjectPoses& poses, std::size_t detection_index);

}  // namespace houghstream
