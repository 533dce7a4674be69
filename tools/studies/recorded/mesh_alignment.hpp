#pragma once

#include <Eigen/Geometry>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {

/// Gives the pose of one mesh on another of the same object, and its reliability.
struct MeshAlignment {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  /// Root mean square distance from the source's surface to the target's, metres; what is far off (parts that the
  /// target lacks) counts as 10 mm.
  double rms_m = 0.0;
  /// RMS of the next best rotation, at least 20 degrees from the best; NaN where all rotations converged to the best.
  /// Near `rms_m` the shape is ambiguous between the two.
  double next_rms_m = 0.0;
};

/// Registers `source` to `target`, metres, by shape alone and from any turn: point-to-plane steps (Chen & Medioni 1992)
/// under Tukey's weights from turns spread over all rotations, both middles on each other at first; the best few with
/// more points to the end. Same meshes, same result. Throws InputError for meshes without triangles.
MeshAlignment align_meshes(const Mesh& source, const Mesh& target);

/// Returns T_target_source, registered in the same way from a start that is off by a centimetre at most.
Eigen::Isometry3d refined_alignment(const Mesh& source, const Mesh& target, const Eigen::Isometry3d& T_start);

}  // namespace houghstream
