#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pipeline/geometry/renderer.hpp"
#include "pose/registration/registration.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

// The cells in which the image of an object is compared, here and in texture_comparison. The numbers are chosen by what
// they mean, not fitted; what the result is worth is learnt (TextureSettings).
constexpr int kObjectCells = 48;  ///< number of cells along the longer side of the object in the image
/// Number of cells that count as one observation, since neighbours are correlated. All cells share one image, one mesh
/// and one pose, so that even these observations are dependent: kEvidenceTempering reduces their weight for that.
constexpr double kObservationCells = 4.0;
constexpr double kEvidenceTempering = 0.3;

/// Holds a pose that is equivalent by shape, or nearly so, and how much likelier the image is under it than under the
/// pose with which it is compared: the logarithm of the ratio.
struct EquivalentPose {
  Eigen::Isometry3d T_camera_object;
  double log_ratio = 0.0;
};

/// Returns the poses that only texture, silhouette or handle tell from this one, since depth agrees with them as well.
/// Nearly equivalent ones (ObjectModel::near_alternatives) are registered to the depth first, with what the pixels say
/// that the model covers at one of both poses only (ForegroundEvidence), as in region-based tracking (Prisacariu and
/// Reid 2012, "PWP3D"). Turns about a nearly round shape's axis (ObjectModel::partial_alternatives) have the evidence
/// of its handle (HandleObserver), and are none where the handle is visible at the pose. `rendered` is the model at the
/// pose.
std::vector<EquivalentPose> find_equivalent_poses(const ObjectObservation& observation,
                                                  const Eigen::Isometry3d& T_camera_object,
                                                  const RenderedRegion& rendered, const DepthTolerance& tolerance,
                                                  const RegistrationSettings& registration);

}  // namespace houghstream
