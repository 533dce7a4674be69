#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace houghstream {

/// Describes a continuous symmetry: rotations by any angle about the line through `offset` along `axis` leave the
/// object as it is.
struct ContinuousSymmetry {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();   ///< unit length, object frame
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< a point of the line, object frame, metres
};

/// The motions that leave an object looking as before, as in models_info.json of BOP (Hodan et al. 2018). Each discrete
/// one maps points of the object frame into the object frame, metres; the identity is not listed. Poses that differ by
/// one of them are the same pose.
struct Symmetries {
  std::vector<Eigen::Isometry3d> discrete;
  std::vector<ContinuousSymmetry> continuous;

  bool empty() const { return discrete.empty() && continuous.empty(); }
};

/// Holds the symmetry of a shape within a depth camera's noise, whatever its texture.
struct ShapeSymmetry {
  Symmetries symmetries;
  std::optional<ContinuousSymmetry> nearly_round;  ///< an axis about which all but a handle or the like looks the same
};

}  // namespace houghstream
