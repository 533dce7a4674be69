#pragma once

#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

/// What is reported.
struct EvidenceSettings {
  /// Smallest score that is reported: in development_world_20 to 67 95 % of the detections from 0.60 on are true.
  float threshold = 0.65F;
  /// Weaker ones from here on are found as candidates (Detection::reported), for a pose to confirm; 1: none are.
  float candidates_from = 1.0F;
  int max_candidates = 16;  ///< the strongest; a frame full of weak maxima must not hold up the poses of the others
  int max_rotations = 48;   ///< rotations handed to the pose process
  bool learn_camera_colours = true;  ///< views are brought to the colours of the camera, see camera_chroma.hpp
};

template <typename Visit>
void fields(const EvidenceSettings& /*settings*/, const Visit& visit) {
  using S = EvidenceSettings;
  visit(number("threshold", &S::threshold, 0, 1));
  visit(number("candidates_from", &S::candidates_from, 0, 1));
  visit(number("max_candidates", &S::max_candidates, 0, 1000000));
  visit(number("max_rotations", &S::max_rotations, 0, 1000000));
}

}  // namespace houghstream
