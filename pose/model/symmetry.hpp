#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "pipeline/geometry/symmetry.hpp"

namespace houghstream {

/// Returns all symmetries as single motions of the object frame (metres), the identity first. A continuous symmetry
/// becomes rotations by equal steps, so many that no point of the object moves by more than about `max_step` diameters
/// from one to the next; each is combined with each discrete one. This follows get_symmetry_transformations() of
/// bop_toolkit (Hodan et al. 2020): 315 rotations for its 0.01. With several axes each is rotated about by itself,
/// which for a ball is less than the whole group. Throws InputError unless `max_step` is above 0.
std::vector<Eigen::Isometry3d> expand_symmetries(const Symmetries& symmetries, double max_step = 0.01);

/// Returns the rotation about the symmetry's axis by an angle in radians.
Eigen::Isometry3d rotation_about(const ContinuousSymmetry& symmetry, double angle_rad);

/// Returns the symmetry S for which R_camera_object * S is nearest to the reference, by the angle between them. It is
/// exact: nothing is discretised, and two or more continuous axes mean a ball, which can be rotated to any reference.
/// Ties go to the identity, then to the first listed.
Eigen::Isometry3d symmetry_towards(const Eigen::Quaterniond& R_camera_object, const Eigen::Quaterniond& R_reference,
                                   const Symmetries& symmetries);

/// Returns the equivalent rotation that is nearest to the reference. Votes are brought together like this before they
/// are averaged, errors before they are measured.
Eigen::Quaterniond nearest_equivalent(const Eigen::Quaterniond& R_camera_object, const Eigen::Quaterniond& R_reference,
                                      const Symmetries& symmetries);

/// Returns the equivalent pose whose rotation is nearest to the reference's.
Eigen::Isometry3d nearest_equivalent(const Eigen::Isometry3d& T_camera_object, const Eigen::Isometry3d& T_reference,
                                     const Symmetries& symmetries);

}  // namespace houghstream
