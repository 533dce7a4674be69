#pragma once

#include <array>
#include <utility>
#include <vector>

#include "detector/voting/hypotheses.hpp"
#include "pipeline/types/detection.hpp"

namespace houghstream {

/// What backproject_box needs for itself, to be kept from box to box.
struct BoxMemory {
  std::vector<float> weights;
  std::array<std::vector<float>, 4> sides;          ///< of the supporting patches
  std::vector<std::pair<float, float>> remembered;  ///< a side of the remembered views, and their weights
};

/// Box by back-projection of all supporting patches (paper, Section 2), frame pixels. Patches at an object's rim see
/// little of it and support it weakly, so each side moves out to where the training views that the votes
/// remember have theirs, unless the patches end so far from it that the object must be hidden there.
cv::Rect2f backproject_box(const Forest& forest, const Hypothesis& hypothesis, const PatchGrid& patches,
                           const Camera& camera, BoxMemory& memory);

/// Strongest first; one whose box overlaps that of a stronger one of its class, or of a significantly stronger one of
/// another class (paper, Section 2), by more than the settings allow is dropped (non-maximum suppression).
std::vector<Detection> suppress_overlaps(std::vector<Detection> detections, const SuppressionSettings& settings);

}  // namespace houghstream
