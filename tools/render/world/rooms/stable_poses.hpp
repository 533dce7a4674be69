#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::world {

/// A way in which a thing lies still on a level table. Table frame: z up, z = 0 on its top.
struct StablePose {
  Eigen::Matrix3d R_table_object = Eigen::Matrix3d::Identity();
  double origin_height_m = 0.0;  ///< height of the object frame's origin over the table
  double centre_height_m = 0.0;  ///< height of its centre of mass
  double margin_m = 0.0;         ///< distance from the centre of mass's foot to the nearest border of the support

  /// Slope on which it tips over or rolls off, whichever way it is turned.
  double steepest_slope_rad() const;
};

/// Attitudes that differ by a turn or a reflection only: a can's side is a family, its lid another. Never empty.
using StablePoseFamily = std::vector<StablePose>;

/// All families that a thing of even density, dropped in any attitude, is found in; each attitude once. What tips over
/// on a slope of 1 degree does not rest. Surface within `nearly_m` of the table carries it too: that of a scan is never
/// quite flat. Same result on every call. Throws InputError for a mesh without volume.
std::vector<StablePoseFamily> find_stable_poses(const Mesh& mesh, double nearly_m = 0.0);

/// Returns the families without the one that stands upright, z up. Throws InputError where none is left.
std::vector<StablePoseFamily> lying_families(const std::vector<StablePoseFamily>& families);

}  // namespace houghstream::world
