#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/types/frame.hpp"
#include "pipeline/types/object_pose.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// An object that was posed before, and where it may be in a frame.
struct ExpectedObject {
  int class_id = 0;
  std::string class_name;
  float score = 0.0F;                     ///< of the detections that it was found by
  std::vector<Eigen::Isometry3d> starts;  ///< T_camera_object, the likeliest first; at least one
  bool settle = false;                    ///< its print may move it a little too, at some cost
  bool is_lost = false;                   ///< it is looked for as far away as a detection's pose is
  bool tell_hidden = true;               ///< whether it is hidden where it is expected first: that renders it once more
  std::optional<Verification> verified;  ///< of an earlier frame: its outline is taken for this one's
};

/// What came of it.
struct FollowedPose {
  ObjectPose pose;  ///< without a detection; its status says why where there is none
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();  ///< where the best attempt ended, withheld or not
  std::optional<Verification> verified;                               ///< of the last rendering
};

/// Registers the model from each start in turn until the evidence suffices (PoseSettings::follow): coarsely and finely
/// as Stoiber et al. (2022) follow objects, by few points of the view, then verified as any pose is. Rendering the
/// model costs most: with an outline of an earlier frame, points of the view take its place as long as they suffice.
/// What is withheld has always been rendered. Where nothing suffices and the object is hidden where it was expected
/// first, its status is kOccluded (ExpectedObject::tell_hidden).
FollowedPose follow_object(const SeenFrame& frame, const ObjectModel& model, const ExpectedObject& expected,
                           const PoseSettings& settings);

}  // namespace houghstream
