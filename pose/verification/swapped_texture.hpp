#pragma once

#include <optional>

#include "pose/verification/quality.hpp"

namespace houghstream {

/// Returns the evidence that there would be if the object had another texture: each point has the colours of the point
/// opposite, as the camera sees the model's middle. Returns nothing where that is much the same texture, or the model
/// has no colours.
std::optional<PoseEvidence> evidence_with_swapped_texture(const ObjectObservation& observation,
                                                          const Eigen::Isometry3d& T_camera_object,
                                                          const PoseEvidence& original,
                                                          const VerificationSettings& settings);

}  // namespace houghstream
