#pragma once

#include "pose/registration/candidates.hpp"
#include "pose/registration/region.hpp"
#include "pose/registration/registration.hpp"
#include "pose/registration/rotation_clusters.hpp"
#include "pose/verification/colour_score.hpp"

namespace houghstream {

/// What is seen of a detection.
struct SeenRegion {
  const RgbdFrame& frame;
  LabRegion colours;  ///< around the region's box
  const DepthRegion& region;
};

/// Registration from coarse to fine: coarsely from all candidates; the best is registered finely and turned about its z
/// axis, where votes err most; of the turns, each registered again and moved a little uphill, the one for which depth,
/// colour and votes speak most goes on; then its print may turn it a little, and registration has the last word. No
/// inliers where nothing stayed near `centre_camera`.
RegistrationResult refine_candidates(const SeenRegion& seen, const ObjectModel& model,
                                     const Eigen::Vector3f& centre_camera, const std::vector<PoseCandidate>& candidates,
                                     const std::vector<RotationCandidate>& votes, const PoseSettings& settings);

}  // namespace houghstream
