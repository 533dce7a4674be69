#pragma once

#include <optional>
#include <vector>

#include "pose/registration/registration.hpp"
#include "pose/seen/region.hpp"

namespace houghstream {

/// Compares a pose's texture with that of its alternatives (ObjectModel::alternatives).
struct PrintComparison {
  /// Log odds of the pose against all alternatives, given the image. It is about minus the logarithm of their number
  /// where the texture is not informative: the model has no colours, is untextured, or is hardly visible.
  double margin = 0.0;
  /// The alternative under which the image is clearly likelier than under the pose, camera from object; nothing where
  /// there is none.
  std::optional<Eigen::Isometry3d> better;
};

/// Compares the print that the model shows at the pose, and at each alternative whose depth agrees as well, with what
/// is seen over the visible face. Both are parted into bands of detail, and of each band and colour channel the seen
/// variance that is left over by least squares on the model's, with a gain within limits, gives a likelihood: exposure
/// drops out with the mean, shading with the coarse lightness, a cast with the mean chroma but for so much of it as no
/// camera makes. Nothing where the pose has no alternatives. `registration` brings near ones to where depth has them.
/// After the background-free correlation of Lewis (1995, "Fast Normalized Cross-Correlation") and the Gaussian
/// likelihood whose maximum over gain and offset that is.
std::optional<PrintComparison> compare_print(const ObjectObservation& seen, const Eigen::Isometry3d& T_camera_object,
                                             const DepthTolerance& tolerance, const RegistrationSettings& registration);

}  // namespace houghstream
