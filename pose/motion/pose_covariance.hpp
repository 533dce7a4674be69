#pragma once

#include <Eigen/Geometry>

#include "pipeline/types/object_pose.hpp"
#include "pipeline/types/tracked_object.hpp"

namespace houghstream {

/// Extent of a pose's object, as far as the uncertainty of the pose depends on it.
struct ObjectExtent {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< centre of the bounding box, object frame, metres
  double radius_m = 0.0;                             ///< half the bounding box' diagonal
};

/// Returns the covariance of one measured pose: translation, m^2, then rotation, rad^2, along and about the world's
/// axes. It grows with the distance, more along the line of sight than across it, and where little of the object is
/// seen. The pose must have a T_camera_object.
Covariance6 measured_pose_covariance(const ObjectPose& pose, const Eigen::Isometry3d& T_world_camera,
                                     const ObjectExtent& extent);

}  // namespace houghstream
