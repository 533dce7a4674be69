#pragma once

#include <vector>

#include "pose/registration/candidates.hpp"

namespace houghstream {

/// Lays a thin object on the plane of its observation's foreground, either side up and at all angles about the plane's
/// normal, and moves it along the plane to where its silhouette agrees best with the foreground. Returns the best poses
/// with their mean evidence, best first, at most `maximum`; none without a foreground.
std::vector<PoseCandidate> flat_candidates(const ObjectObservation& observation, int maximum);

}  // namespace houghstream
