#pragma once

#include <Eigen/Geometry>

#include "pipeline/types/tracked_object.hpp"

namespace houghstream {

// Small motions of a pose T_a_b. A twist holds six numbers: a shift v, metres, before a rotation vector w, its axis
// times radians. Three conventions are in use. Each has an arithmetic of its own, on which results depend to the last
// bit, so that none stands for another:
//
//   about the world's axes  R' = exp(w) R, t' = t + v, along and about the axes of frame a (left perturbation of Sola,
//                           Deray and Atchuthan 2018, "A micro Lie theory", with the shift apart). Computes with unit
//                           quaternions. For MotionFilter, the tracks, and the places of cameras.
//   about the body          T' = T (exp(w), v), along and about the axes of frame b (right perturbation). Computes with
//                           matrices and makes the product a rotation again. For the alignment of frames, the pose
//                           graph, and the registration of models: there T_a_b is T_camera_world, and the world moves.
//   about a point           the point is the origin of frame b: it is shifted along the axes of frame a, and the pose
//                           rotates about it. Computes with matrices, and leaves them as they come. For
//                           SmoothedVelocity, whose caller makes its poses orthonormal in each frame.
//
// The inner loops of registration and fusion have steps of their own, which stand there.

/// Returns the pose with its rotation orthonormal again. Each product leaves rounding in it, and a product with the
/// inverse of a pose, which is taken as the transpose, multiplies what is there.
Eigen::Isometry3d orthonormalised(const Eigen::Isometry3d& T);

/// Returns the rotation vector of a rotation, radians.
Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);

/// Returns the twist about the world's axes that leads from one pose to another.
Vector6 local_coordinates_about_world(const Eigen::Isometry3d& T_to, const Eigen::Isometry3d& T_from);

/// Returns the pose to which a twist about the world's axes leads from T.
Eigen::Isometry3d retract_about_world(const Eigen::Isometry3d& T, const Vector6& twist);

/// Returns a pose between two, at constant velocity about the world's axes: the first at fraction 0, the second at 1.
Eigen::Isometry3d interpolate_pose(const Eigen::Isometry3d& T_first, const Eigen::Isometry3d& T_second,
                                   double fraction);

/// Returns the twist of a motion about the body: retract_about_body() of the identity returns the motion.
Vector6 local_coordinates_about_body(const Eigen::Isometry3d& motion);

/// Returns the pose to which a twist about the body leads from T.
Eigen::Isometry3d retract_about_body(const Eigen::Isometry3d& T, const Vector6& twist);

/// Returns the pose T with its origin shifted (metres) and rotated about it by a rotation vector (radians).
Eigen::Isometry3d retract_about_point(const Eigen::Isometry3d& T, const Eigen::Vector3d& shift,
                                      const Eigen::Vector3d& rotation);

}  // namespace houghstream
