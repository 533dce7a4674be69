#pragma once

#include <optional>

#include "pose/verification/quality.hpp"

namespace houghstream {

/// What there would be if the object had another print: the colours of each point are those of the point opposite, as
/// the camera sees the model's middle. Nothing where that is much the same print, or the model has no colours.
std::optional<PoseEvidence> evidence_of_other_print(const SeenObject& seen, const Eigen::Isometry3d& T_camera_object,
                                                    const PoseEvidence& own, const VerificationSettings& settings);

}  // namespace houghstream
