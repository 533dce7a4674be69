#pragma once

#include <Eigen/Core>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::world {

/// Describes a pose in which an asset rests on a level table. Table frame: z up, z = 0 on its top.
struct StablePose {
  Eigen::Matrix3d R_table_object = Eigen::Matrix3d::Identity();
  double origin_height_m = 0.0;  ///< height of the object frame's origin over the table
  double centre_height_m = 0.0;  ///< height of its centre of mass
  double margin_m = 0.0;         ///< distance from the centre of mass's foot to the nearest border of the support

  /// Returns the slope on which it tips over or rolls off in the worst direction.
  double steepest_slope_rad() const;
};

/// Attitudes that differ by a turn or a reflection only: a can's side is a family, its lid another. Never empty.
using StablePoseFamily = std::vector<StablePose>;

/// Finds all families of stable poses of an asset of even density dropped in any attitude; each pose once. A pose that
/// tips over on a slope of 1 degree is not stable. Surface within `nearly_m` of the table supports it too, since that
/// of a scan is never quite flat. The result is the same on every call. Throws InputError for a mesh without volume.
std::vector<StablePoseFamily> find_stable_poses(const Mesh& mesh, double nearly_m = 0.0);

/// Returns the families without the one that stands upright, z up. Throws InputError where none is left.
std::vector<StablePoseFamily> lying_families(const std::vector<StablePoseFamily>& families);

}  // namespace houghstream::world
