#pragma once

#include <opencv2/core.hpp>

#include "detector/forest/beliefs.hpp"
#include "detector/forest/patch_grid.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Patches of a frame at both levels with what they believe; for depth-normalised forests.
struct SeenPatches {
  PatchGrid grid;
  PatchBeliefs beliefs;
  Camera hough_camera;  ///< in whose pixels Hough spaces are laid out: that of the level for near surfaces
  cv::Mat colour;       ///< of the working frame for near surfaces, BGR
};

/// Closes the stages "detect.resize", "detect.features" and "detect.forest" on the clock. What `seen` held is
/// overwritten and its memory used again.
void classify_patches(const Forest& forest, const RgbdFrame& frame, const DetectionSettings& settings,
                      StageClock& clock, SeenPatches& seen);

}  // namespace houghstream
