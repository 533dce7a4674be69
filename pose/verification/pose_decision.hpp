#pragma once

#include "pipeline/types/object_pose.hpp"
#include "pose/registration/registration.hpp"
#include "pose/verification/quality.hpp"

namespace houghstream {

constexpr double kQualityMargin = 1e-6;  ///< logits of qualities differ down to this from 0 and 1

/// Sets the qualities of `pose` from the evidence for `T_camera_object`, and then either the pose itself or the status
/// with the reason for its rejection. The object can only be refuted where it was `reported` (see Detection). `quality`
/// is that of the object's class.
void decide_status(const PoseEvidence& evidence, const Eigen::Isometry3d& T_camera_object, bool reported,
                   const QualitySettings& quality, ObjectPose& pose);

/// Lowers the qualities of a published pose where its object differs in chroma from a surer one of its class in the
/// same frame: both are seen by one camera in one light, so that objects of one model look alike there, whatever the
/// camera makes of colours. A pose that falls below its minimum is rejected by colour. Both poses have a chroma.
void compare_with_instance(const ObjectPose& surer, bool reported, const QualitySettings& quality, ObjectPose& pose);

/// Returns PoseEvidence::texture_probability of a decided pose, for one that continues it.
float texture_probability_of(const ObjectPose& pose);

/// Copies the evidence of a registration into the pose.
void copy_registration_evidence(const RegistrationResult& result, ObjectPose& pose);

}  // namespace houghstream
