#pragma once

#include <vector>

#include "detector/detector_settings.hpp"
#include "detector/evidence/score.hpp"
#include "pipeline/types/detection.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// A hypothesis that the Hough space offers, before it is decided whether to believe in it.
struct Candidate {
  Detection detection;  ///< complete but for its score, which is the model's for the evidence
  Evidence evidence;
};

/// All hypotheses of all classes, class by class, each class's strongest vote mass first. Closes the stages "detect.*"
/// on the clock. Views in `forgotten` are not compared with the frame: validation must not recognise the very picture
/// it shows.
/// Candidates below settings.threshold come without rotations.
std::vector<Candidate> find_candidates(const Forest& forest, const RgbdFrame& frame, const DetectionSettings& settings,
                                       StageClock& clock, const std::vector<std::uint32_t>& forgotten = {});

}  // namespace houghstream
