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

/// Inputs of score_by_group() that the hypotheses of one forest share.
struct ScoringInput {
  const ForestIndex& index;
  const LabFrame& frame;
  const PatchGrid& patches;
  const EvidenceSettings& settings;
  /// Indices into Forest::views of templates that are not compared with the frame.
  const std::vector<std::uint32_t>& excluded_views;
};

/// The hypotheses of one of the forests that a frame is searched with, and what they are scored with. What it refers to
/// must outlive it.
struct GroupHypotheses {
  ScoringInput input;
  const std::vector<Hypothesis>& hypotheses;
};

/// The candidates of each group.
using GroupCandidates = std::vector<std::vector<ScoredHypothesis>>;

/// Workspace of score_by_group(), used again from frame to frame.
struct ScoringWorkspace {
  struct Worker {
    std::vector<PlacedTemplate> visited;       ///< templates that the current refinement has compared
    std::vector<PlacedTemplate> best_visited;  ///< templates that the best refinement so far has compared
    std::vector<std::pair<std::uint32_t, float>> weighted_views;  ///< views with the weight of their rotation
    BoxWorkspace box;
  };
  PerWorker<Worker> workers;
  std::vector<std::vector<PlacedTemplate>> compared;  ///< templates that were compared with the frame, per hypothesis
};

/// Scores the hypotheses of all groups: how templates match the frame at each centre, the score that follows, the box.
/// Time is spent where it may matter, whatever the number of groups: EvidenceSettings::max_compared hypotheses, those
/// whose votes promise most, are compared with the frame, and max_refined of them, those that then score highest, are
/// refined; settings are those of the first group. The likely ones come first: what lies on the surface that one of
/// them explains (EvidenceSettings::explains_from) is dropped, since a part of an object easily looks like another one,
/// the more so the more objects are known. Hypotheses that are not compared or dropped have no candidate; the others
/// keep their order. The result is the same for any number of threads.
GroupCandidates score_by_group(const std::vector<GroupHypotheses>& groups, int threads, ScoringWorkspace& workspace);

}  // namespace houghstream
