#pragma once

#include "pipeline/types/object_pose.hpp"
#include "pose/pose_settings.hpp"

namespace houghstream {

/// Fills in what the evidence for `T_camera_object` says of `pose`: its quality, and the pose itself or the reason why
/// it is withheld: of what is `reported` (see Detection) that the object is refuted, where it is. The class is read
/// from `pose`.
void judge(const PoseEvidence& evidence, const Eigen::Isometry3d& T_camera_object, bool reported,
           const PoseSettings& settings, ObjectPose& pose);

/// Copies what registration says of itself.
void tell_registration(const RegistrationResult& result, ObjectPose& pose);

}  // namespace houghstream
