#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/geometry/symmetry.hpp"
#include "pose/model/mesh_bvh.hpp"

namespace houghstream {

/// A mesh with what its surface is measured by: made once, for all searches in it. Keeps a reference to the mesh.
struct MeasuredMesh {
  /// Throws InputError for a mesh without triangles.
  explicit MeasuredMesh(const Mesh& measured) : mesh(measured), tree(measured), diameter_m(mesh_diameter(measured)) {}

  const Mesh& mesh;
  MeshBvh tree;
  double diameter_m;
};

/// Limits within which two views look the same.
struct SymmetrySearch {
  /// A rotation fits while no point of the surface ends up farther from the surface than this, in diameters: the
  /// Hausdorff distance with which BOP finds candidates (Hodan et al. 2020), which allows 0.1 and leaves the choice to
  /// people. Whatever deviates by less is no error that MSSD would see at its strictest threshold of 0.05.
  double tolerance = 0.01;
  double min_tolerance_m = 0.0;  ///< the tolerance is not smaller than this, metres, but for very small objects
  /// Distance of a single point from the surface, in tolerances. Above 1 a rotation fits where the root mean square
  /// over the surface is within the tolerance: a scanned carton bulges.
  double max_deviation = 1.0;
  /// Shape only, or colours too: a printed box has a shape whose symmetries its print breaks. A mesh without colours
  /// has nothing to compare.
  bool compare_colours = false;
  double colour_difference = 0.1;        ///< points differ from here on, mean of the channels, 1 = black against white
  double max_differing_fraction = 0.05;  ///< share of the surface that may differ: sensor noise, grain, seams
};

/// The symmetries of a mesh, metres: continuous where any angle about an axis fits, with half a turn about one
/// perpendicular axis where that fits too; two continuous axes are a ball. Else n-fold turns, n from 2 to 6, and all
/// that they combine to. Mirror images are no motions. A symmetry keeps the second moments of the surface: its axis is
/// a principal one, or where two or three of these spread alike within the tolerance, any in their plane or any at all.
/// Box axes and principal axes through the centroid come first; a rotation that does not fit as it is, is registered
/// with the mesh itself. The discrete ones are a whole group: the product of two of them is one of them, registered
/// where it does not fit as it is. Throws InputError for a mesh without surface.
Symmetries find_symmetries(const Mesh& mesh, const SymmetrySearch& settings = {});

/// The rotations after which a depth camera measures the same: those of the shape within its noise, print aside. Where
/// no rotation by any angle fits, `nearly_round` is an axis about which most of the surface maps onto itself at any
/// angle: a mug's, which its handle breaks. Throws InputError for a mesh without surface.
ShapeSymmetry find_shape_symmetry(const MeasuredMesh& measured);
ShapeSymmetry find_shape_symmetry(const Mesh& mesh);

/// Whether a motion's rotation is less than an angle from that of a known one.
bool is_near_any(const Eigen::Isometry3d& T, const std::vector<Eigen::Isometry3d>& known, double angle_rad);

/// All that turns combine to, without the identity; at most 59, and none within 25 degrees of another.
std::vector<Eigen::Isometry3d> group_of(const std::vector<Eigen::Isometry3d>& rotations);

/// Says of a motion of the object frame, metres, whether the object looks the same after it. Inspects 1000 evenly
/// spread points of the surface, and up to 2000 of its vertices: corners deviate most.
class RotationSymmetryTest {
 public:
  /// Keeps a reference to `measured`. Throws InputError for a mesh without surface.
  RotationSymmetryTest(const MeasuredMesh& measured, const Eigen::Vector3d& centre, const SymmetrySearch& settings);

  /// The rotation about an axis through the centre.
  Eigen::Isometry3d rotation_about_axis(const Eigen::Vector3d& axis, double angle_rad) const;
  /// The root mean square of the deviation may be as large as `rms` tolerances.
  bool is_symmetric_under(const Eigen::Isometry3d& T, double rms = 1.0) const;
  bool is_symmetric_under(const Eigen::Vector3d& axis, double angle_rad) const {
    return is_symmetric_under(rotation_about_axis(axis, angle_rad));
  }
  /// Mean distance, metres, of a hundred moved points from the surface.
  double deviation(const Eigen::Isometry3d& T) const;
  /// The motion near `T` that lays the moved surface on the surface (point-to-plane ICP, Chen and Medioni 1992, with
  /// Geman and McClure's kernel).
  Eigen::Isometry3d registered(const Eigen::Isometry3d& T) const;
  /// Fraction of the surface that maps onto itself at any angle about the axis, what lies across the axis left out.
  double round_fraction(const ContinuousSymmetry& axis) const;
  double diameter_m() const { return measured_.diameter_m; }
  const SurfacePoints& surface() const { return surface_; }
  const Eigen::Vector3d& centre() const { return centre_; }
  double tolerance_m() const { return tolerance_m_; }

 private:
  /// Distance from the surface, metres; `limit_m` where it is not less.
  float distance(const Eigen::Vector3f& point, float limit_m) const {
    return measured_.tree.nearest(point, limit_m).distance;
  }
  /// Share of the samples whose colour is another where the rotation takes them.
  double differing_fraction(const Eigen::Isometry3f& T) const;

  const MeasuredMesh& measured_;
  SymmetrySearch settings_;
  Eigen::Vector3d centre_;
  float tolerance_m_;
  SurfacePoints surface_;
  std::vector<Eigen::Vector3f> corners_;
  std::vector<Eigen::Vector3f> colours_;  ///< of the surface's points; empty where they are not compared
};

}  // namespace houghstream
