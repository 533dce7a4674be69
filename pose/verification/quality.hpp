#pragma once

#include <array>
#include <optional>

#include "pipeline/types/object_pose.hpp"
#include "pose/verification/colour_score.hpp"
#include "pose/verification/verification.hpp"

namespace houghstream {

/// What speaks for a pose and against it.
struct PoseEvidence {
  float detection_score = 0.0F;
  Verification depth;
  std::optional<ColourComparison> colour;  ///< nothing where the model has no colours
};

/// The evidence as the terms of the regression, larger is better:
/// 0 log odds of the detection score
/// 1 log of the share that was seen through, of what agrees or was seen through (negated)
/// 2 log of the visible fraction
/// 3 log of outline ends over outline that goes on
/// 4 shift of chroma, tens of CIE L*a*b* units (negated)
/// 5 contrast that the model's colours leave unexplained, beyond the 18 units that right poses have, tens of units
///   (negated)
/// Those of colour are the typical ones where the model has none.
using QualityTerms = std::array<double, 6>;
QualityTerms quality_terms(const PoseEvidence& evidence, const QualitySettings& settings);

/// Probability in [0, 1] that the pose is right: the object is the one that was detected, and its ADD-S error is below
/// a tenth of the diameter.
float pose_quality(const QualityTerms& terms, const QualitySettings& settings);

/// The status that names the term which speaks most against the pose.
PoseStatus reason_against(const QualityTerms& terms, const QualitySettings& settings);

}  // namespace houghstream
