#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "detector/evidence/boxes.hpp"
#include "detector/evidence/evidence_settings.hpp"
#include "detector/evidence/score.hpp"
#include "detector/evidence/template_alignment.hpp"
#include "detector/forest/forest_index.hpp"
#include "detector/voting/hypotheses.hpp"
#include "pipeline/types/detection.hpp"

namespace houghstream {

/// A hypothesis of the Hough space with its score, before suppression.
struct ScoredHypothesis {
  Detection detection;  ///< complete; without rotations where its score is too low for a candidate
  Evidence evidence;
};

/// Inputs of score_hypotheses().
struct ScoringInput {
  const ForestIndex& index;
  const LabFrame& frame;
  const PatchGrid& patches;
  const EvidenceSettings& settings;
  /// Indices into Forest::views of templates that are not compared with the frame.
  const std::vector<std::uint32_t>& excluded_views;
};

/// Workspace of score_hypotheses(), used again from frame to frame.
struct ScoringWorkspace {
  struct Worker {
    std::vector<PlacedTemplate> compared;      ///< templates of a hypothesis, compared with the frame
    std::vector<PlacedTemplate> visited;       ///< templates that were compared while one was refined
    std::vector<PlacedTemplate> best_visited;  ///< templates of the refinement that led to the best match
    std::vector<std::pair<std::uint32_t, float>> weighted_views;  ///< views with the weight of their rotation
    BoxWorkspace box;
  };
  PerWorker<Worker> workers;
};

/// Returns a candidate for each hypothesis, in their order: its box, how the templates match the frame at its centre,
/// and the score that follows. The result is the same for any number of threads.
std::vector<ScoredHypothesis> score_hypotheses(const ScoringInput& input, const std::vector<Hypothesis>& hypotheses,
                                               int threads, ScoringWorkspace& workspace);

/// Returns how many times as many views a class has as one that was taught in one attitude, 1 to 3.
float attitude_spread(const Forest& forest, std::uint32_t class_index);

}  // namespace houghstream
