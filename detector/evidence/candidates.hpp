#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "detector/evidence/evidence_settings.hpp"
#include "detector/evidence/score.hpp"
#include "detector/evidence/template_alignment.hpp"
#include "detector/forest/forest_index.hpp"
#include "detector/voting/boxes.hpp"
#include "detector/voting/hypotheses.hpp"
#include "pipeline/types/detection.hpp"

namespace houghstream {

/// A hypothesis that the Hough space offers, weighed but not yet decided on.
struct Candidate {
  Detection detection;  ///< complete, with its score; without rotations where it is too weak for a candidate
  Evidence evidence;
};

/// What hypotheses are weighed by.
struct EvidenceInput {
  const ForestIndex& index;
  const LabFrame& frame;
  const PatchGrid& patches;
  const EvidenceSettings& settings;
  const std::vector<std::uint32_t>& excluded_views;  ///< into Forest::views: not compared with the frame
};

/// What weigh_evidence needs for itself, to be kept from frame to frame.
struct EvidenceMemory {
  struct Worker {
    std::vector<PlacedTemplate> compared;
    std::vector<PlacedTemplate> way;                       ///< what was looked at from one view to a better one
    std::vector<PlacedTemplate> best_way;                  ///< the same to the best
    std::vector<std::pair<std::uint32_t, float>> weighed;  ///< views, and how much they speak for their rotation
    BoxMemory box;
  };
  PerWorker<Worker> workers;
};

/// A candidate for each hypothesis, in their order: its box, what the remembered views say to it where they are put at
/// its centre, and its score. The same for any number of threads.
std::vector<Candidate> weigh_evidence(const EvidenceInput& input, const std::vector<Hypothesis>& hypotheses,
                                      int threads, EvidenceMemory& memory);

/// Over how many times as many views a class is spread as one that was taught in one attitude: 1 to 3.
float attitude_spread(const Forest& forest, std::uint32_t class_index);

}  // namespace houghstream
