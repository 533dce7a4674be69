#pragma once

namespace houghstream {

/// What is reported.
struct EvidenceSettings {
  /// Smallest score that is reported: in development_world_20 to 67 95 % of the detections from 0.60 on are true.
  float threshold = 0.65F;
  /// Weaker ones from here on are found as candidates (Detection::reported), for a pose to confirm; 1: none are.
  float candidates_from = 1.0F;
  int max_candidates = 16;  ///< the strongest; a frame full of weak maxima must not hold up the poses of the others
  int max_rotations = 48;   ///< rotations handed to the pose process
};

}  // namespace houghstream
