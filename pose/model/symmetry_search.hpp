#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "pose/model/mesh_bvh.hpp"

namespace houghstream {

/// What counts as looking the same.
struct SymmetrySearch {
  /// A turn fits while no point of the surface ends up farther from the surface than this, in diameters: the Hausdorff
  /// distance with which BOP finds candidates (Hodan et al. 2020), which allows 0.1 and leaves the choice to people.
  /// Whatever deviates by less is no error that MSSD would see at its strictest threshold of 0.05.
  double tolerance = 0.01;
  /// Shape only, or colours too: a printed box has a shape whose symmetries its print breaks. A mesh without colours
  /// has nothing to compare.
  bool compare_colours = false;
  double colour_difference = 0.1;   ///< points differ from here on, mean of the channels, 1 = black against white
  double largest_differing = 0.05;  ///< share of the surface that may differ: sensor noise, grain, seams
};

/// The symmetries of a mesh, metres: turns about the principal axes and the box axes of its object frame, through its
/// centroid, which every symmetry keeps in place. Continuous where any angle fits, with half a turn about one
/// perpendicular axis where that fits too; two continuous axes are a ball. Else n-fold turns, n from 2 to 6, and all
/// that they combine to. Mirror images are no motions; symmetries about other axes (those of a tilted cube, whose
/// principal axes are undefined) are not found. Throws InputError for a mesh without surface.
Symmetries find_symmetries(const Mesh& mesh, const SymmetrySearch& settings = {});

/// Says of a turn about an axis through a point of the object frame whether the object looks the same after it. Looks
/// at 1000 evenly spread points of the surface, and at up to 2000 of its vertices: corners deviate most.
class RotationSymmetryTest {
 public:
  /// Keeps a reference to `mesh`. Throws InputError for a mesh without surface.
  RotationSymmetryTest(const Mesh& mesh, const Eigen::Vector3d& centre, const SymmetrySearch& settings);

  /// The motion of the object frame, metres.
  Eigen::Isometry3d turn(const Eigen::Vector3d& axis, double angle_rad) const;
  bool fits(const Eigen::Vector3d& axis, double angle_rad) const;

 private:
  /// Share of the samples whose colour is another where the turn takes them.
  double differing_fraction(const Eigen::Isometry3f& T) const;

  const Mesh& mesh_;
  SymmetrySearch settings_;
  MeshBvh tree_;
  Eigen::Vector3d centre_;
  float tolerance_m_;
  std::vector<Eigen::Vector3f> samples_;
  std::vector<Eigen::Vector3f> corners_;
  std::vector<Eigen::Vector3f> colours_;  ///< of the samples; empty where they are not compared
};

}  // namespace houghstream
