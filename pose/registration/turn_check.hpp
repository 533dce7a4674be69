#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pose/model/surface_tree.hpp"
#include "pose/model/symmetry_search.hpp"

namespace houghstream {

/// Says of a turn about an axis through a point of the object frame whether the object looks the same after it. Looks
/// at 1000 evenly spread points of the surface, and at up to 2000 of its vertices: corners deviate most.
class TurnCheck {
 public:
  /// Keeps a reference to `mesh`. Throws InputError for a mesh without surface.
  TurnCheck(const Mesh& mesh, const Eigen::Vector3d& centre, const SymmetrySearch& settings);

  /// The motion of the object frame, metres.
  Eigen::Isometry3d turn(const Eigen::Vector3d& axis, double angle_rad) const;
  bool fits(const Eigen::Vector3d& axis, double angle_rad) const;

 private:
  /// Share of the samples whose colour is another where the turn takes them.
  double differing_share(const Eigen::Isometry3f& T) const;

  const Mesh& mesh_;
  SymmetrySearch settings_;
  SurfaceTree tree_;
  Eigen::Vector3d centre_;
  float tolerance_m_;
  std::vector<Eigen::Vector3f> samples_;
  std::vector<Eigen::Vector3f> corners_;
  std::vector<Eigen::Vector3f> colours_;  ///< of the samples; empty where they are not compared
};

}  // namespace houghstream
