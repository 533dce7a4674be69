#include "detector/evidence/suppression.hpp"

#include <algorithm>
#include <utility>

namespace houghstream {

std::vector<Detection> suppress(std::vector<ScoredHypothesis>& candidates, const EvidenceSettings& evidence,
                                const SuppressionSettings& suppression) {
  std::vector<Detection> likely;
  for (ScoredHypothesis& candidate : candidates) {
    Detection& detection = candidate.detection;
    detection.reported = detection.score >= evidence.threshold_of(detection.class_name);
    if (detection.score >= evidence.min_kept_score(detection.class_name)) likely.push_back(std::move(detection));
  }
  std::vector<Detection> kept = suppress_overlaps(std::move(likely), suppression);
  int candidates_left = evidence.max_candidates;
  const auto is_surplus = [&](const Detection& it) { return !it.reported && --candidates_left < 0; };
  kept.erase(std::remove_if(kept.begin(), kept.end(), is_surplus), kept.end());
  return kept;
}

std::vector<Detection> suppress_overlaps(std::vector<Detection> detections, const SuppressionSettings& settings) {
  std::stable_sort(detections.begin(), detections.end(),
                   [](const Detection& a, const Detection& b) { return a.score > b.score; });
  std::vector<Detection> kept;
  for (Detection& detection : detections) {
    const auto overlaps = [&](const Detection& other) {
      const bool dominates = other.class_id == detection.class_id ||
                             (other.score > 0.5F && other.score > settings.dominance * detection.score);
      return dominates && box_iou(other.box_px, detection.box_px) > settings.max_overlap;
    };
    if (std::none_of(kept.begin(), kept.end(), overlaps)) kept.push_back(std::move(detection));
  }
  return kept;
}

}  // namespace houghstream
