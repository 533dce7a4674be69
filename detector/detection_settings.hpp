#pragma once

#include "detector/evidence/evidence_settings.hpp"
#include "detector/forest/patch_settings.hpp"
#include "detector/voting/voting_settings.hpp"

namespace houghstream {

/// How a frame is searched: each stage's settings, which stand beside the stage. profiles.cpp has the named ones.
struct DetectionSettings {
  int threads = 2;  ///< any number gives the same detections
  PatchSpacing spacing;
  LeafSettings leaves;
  VotingSettings voting;
  EvidenceSettings evidence;
  SuppressionSettings suppression;
};

}  // namespace houghstream
