#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "detector/voting/hypotheses.hpp"

namespace houghstream {

/// Workspace of backproject_box(), reused from box to box.
struct BoxWorkspace {
  std::vector<float> weights;
  std::array<std::vector<float>, 4> sides;               ///< sides of the supporting patches
  std::vector<std::pair<float, float>> template_values;  ///< a side of the view templates, and their weights
};

/// Returns the box of a hypothesis by back-projection of all supporting patches (paper, Section 2), frame pixels.
/// Patches at an object's edge see little of it and support it weakly, so each side moves out to where the training
/// views that the votes support have theirs, unless the patches end so far from it that the object must be occluded
/// there.
cv::Rect2f backproject_box(const Forest& forest, const Hypothesis& hypothesis, const PatchGrid& patches,
                           const Camera& camera, BoxWorkspace& workspace);

}  // namespace houghstream
