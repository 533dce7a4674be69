#pragma once

#include "pipeline/types/object_pose.hpp"
#include "pose/registration/registration.hpp"
#include "pose/verification/quality.hpp"

namespace houghstream {

/// Fills in what the evidence for `T_camera_object` says of `pose`: its quality, and the pose itself or the reason why
/// it is withheld: of what is `reported` (see Detection) that the object is refuted, where it is. `quality` is that of
/// the object's class.
void judge(const PoseEvidence& evidence, const Eigen::Isometry3d& T_camera_object, bool reported,
           const QualitySettings& quality, ObjectPose& pose);

/// Copies what registration says of itself.
void tell_registration(const RegistrationResult& result, ObjectPose& pose);

}  // namespace houghstream
