#pragma once

#include <vector>

#include "detector/evidence/evidence_settings.hpp"
#include "detector/evidence/hypothesis_scoring.hpp"
#include "pipeline/types/detection.hpp"

namespace houghstream {

/// Returns the detections that are likely enough to be reported, and candidates, which a pose may confirm, strongest
/// first; of overlapping ones the stronger (non-maximum suppression, Section 2). With one threshold for all classes a
/// candidate never suppresses a detection that is reported; with thresholds of their own, one that is much stronger
/// does. The detections are moved out of `candidates`.
std::vector<Detection> suppress(std::vector<ScoredHypothesis>& candidates, const EvidenceSettings& evidence,
                                const SuppressionSettings& suppression);

/// Returns the detections, strongest first, without those whose box overlaps that of a stronger one of its class, or of
/// a significantly stronger one of another class (Section 2), by more than the settings allow.
std::vector<Detection> suppress_overlaps(std::vector<Detection> detections, const SuppressionSettings& settings);

}  // namespace houghstream
