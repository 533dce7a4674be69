#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/frame.hpp"

// The pose errors of the BOP challenge since 2019 (Hodan et al., "BOP Challenge 2020 on 6D Object Localization", ECCVW
// 2020), as bop_toolkit measures them. Poses map the object frame to the camera frame, metres; symmetries are motions
// of the object frame with the identity among them (pose/model/symmetry.hpp expands them).

namespace houghstream {

/// Returns MSSD, Maximum Symmetry-aware Surface Distance, metres: the largest distance of a vertex from its true place,
/// for the best true pose among the equivalent ones.
double mssd_error(const std::vector<Eigen::Vector3f>& vertices, const std::vector<Eigen::Isometry3d>& symmetries,
                  const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth);

/// Returns MSPD, Maximum Symmetry-aware Projection Distance, pixels: the same in the image. It is infinite where a
/// vertex does not lie in front of the camera.
double mspd_error(const std::vector<Eigen::Vector3f>& vertices, const std::vector<Eigen::Isometry3d>& symmetries,
                  const Eigen::Isometry3d& T_estimated, const Eigen::Isometry3d& T_ground_truth, const Camera& camera);

/// Ten steps from 0.05 to 0.5.
constexpr std::size_t kBopSteps = 10;
constexpr double bop_step(std::size_t index) {
  return 0.05 * static_cast<double>(index + 1);
}

/// Returns VSD, Visible Surface Discrepancy (variant of 2019: cost 0 or 1, what has no measured depth counts as
/// visible): the share of the pixels that see the object in the one pose or the other for which the surfaces are tau
/// apart or more, or which see it in one only. One error for each tau of bop_step() times the diameter. Distances are
/// along the ray; what lies up to delta = 15 mm behind the measured depth is visible. Blind to symmetries that cannot
/// be seen. 1 where nothing is visible. `frame` needs depth and camera only.
std::array<double, kBopSteps> vsd_errors(const Mesh& mesh, double diameter, const Eigen::Isometry3d& T_estimated,
                                         const Eigen::Isometry3d& T_ground_truth, const RgbdFrame& frame);

/// Model of a class for BOP's pose errors.
struct BopModel {
  Mesh mesh;                                  ///< object frame, metres
  double diameter = 0.0;                      ///< metres
  std::vector<Eigen::Isometry3d> symmetries;  ///< the identity among them
};

/// The errors of one estimate against one true pose, without units, so that objects and cameras can be pooled.
struct BopErrors {
  double mssd = 0.0;                       ///< distance in diameters
  double mspd = 0.0;                       ///< pixels of an image 640 wide
  std::array<double, kBopSteps> vsd = {};  ///< discrepancy by tau
};
BopErrors bop_errors(const BopModel& model, const Eigen::Isometry3d& T_estimated,
                     const Eigen::Isometry3d& T_ground_truth, const RgbdFrame& frame);

}  // namespace houghstream
