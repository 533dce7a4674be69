#pragma once

#include <Eigen/Core>

namespace houghstream {

/// What a relief gains in depth beside a picture's optical axis. A view is remembered as it lies across the ray to its
/// centre, depth is measured along the axis: where the ray leaves the axis, the side that is farther from the axis
/// comes nearer. To first order in the distance from the centre: a plane across the ray is met exactly enough over an
/// object.
struct OffAxisSlope {
  float right = 0.0F;  ///< metres of depth per metre to the right of the centre, at its depth
  float down = 0.0F;   ///< the same downwards
};

/// Of a relief whose centre is there, camera frame, metres, z > 0.
inline OffAxisSlope off_axis_slope(const Eigen::Vector3f& centre_camera) {
  const Eigen::Vector2f slope = centre_camera.head<2>() / centre_camera.z();
  const Eigen::Vector2f tilt = -slope / (1.0F + slope.squaredNorm());
  return {tilt.x(), tilt.y()};
}

}  // namespace houghstream
