#pragma once

#include <optional>
#include <vector>

#include "pose/registration/registration.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

/// Result of comparing a pose's texture with that of its alternatives (ObjectModel::alternatives).
struct TextureComparison {
  /// Log odds of the pose against all alternatives, given the image. It is about minus the logarithm of their number
  /// where the texture is not informative: the model has no colours, is untextured, or is hardly visible.
  double margin = 0.0;
  /// The alternative under which the image is clearly likelier than under the pose, camera from object; nothing where
  /// there is none.
  std::optional<Eigen::Isometry3d> better;
  /// The pose, turned about the shape's axes of revolution to where its texture agrees best with the image: the depth
  /// leaves this rotation free. Nothing where there is no such axis, or the texture is not informative.
  std::optional<Eigen::Isometry3d> aligned;
};

/// Compares the texture of the model at the pose, and at each alternative whose depth agrees as well, with the observed
/// one over the visible face. Both are divided into bands of detail, and of each band and colour channel the observed
/// variance that is left by least squares on the model's, blurred as a camera blurs it, with a gain within limits that
/// the exposure sets, gives a likelihood: exposure cancels with the mean, shading with the coarse lightness, a cast
/// with the mean chroma except for the part that no camera causes. Alternatives about an axis of revolution are samples
/// that stand farther apart than letters are wide: the likeliest of them are aligned, as the pose itself is, before
/// they are compared. To the likelihood of an alternative that of its silhouette and its handle is added
/// (find_equivalent_poses). Returns nothing where the pose has no alternatives. It follows the background-free
/// correlation of Lewis (1995, "Fast Normalized Cross-Correlation") and the Gaussian likelihood whose maximum over gain
/// and offset that is.
std::optional<TextureComparison> compare_with_alternatives(const ObjectObservation& observation,
                                                           const Eigen::Isometry3d& T_camera_object,
                                                           const DepthTolerance& tolerance,
                                                           const RegistrationSettings& registration);

}  // namespace houghstream
