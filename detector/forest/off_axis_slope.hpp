#pragma once

#include <Eigen/Core>

namespace houghstream {

/// Depth slope that a template gains off the image's optical axis. A template is stored perpendicular to the ray
/// through its centre, while depth is measured along the optical axis: off the axis, the outer side has less depth.
/// First order in the distance from the centre, which is accurate over the extent of an object.
struct OffAxisSlope {
  float right = 0.0F;  ///< metres of depth per metre to the right of the centre, at its depth
  float down = 0.0F;   ///< metres of depth per metre downwards
};

/// Returns the slope of a template with this centre, camera frame, metres, z > 0.
inline OffAxisSlope off_axis_slope(const Eigen::Vector3f& centre_camera) {
  const Eigen::Vector2f slope = centre_camera.head<2>() / centre_camera.z();
  const Eigen::Vector2f tilt = -slope / (1.0F + slope.squaredNorm());
  return {tilt.x(), tilt.y()};
}

}  // namespace houghstream
