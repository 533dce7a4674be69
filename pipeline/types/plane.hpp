#pragma once

#include <Eigen/Geometry>

namespace houghstream {

/// A plane; its normal has unit length and points to the origin's side, as towards a camera.
using Plane = Eigen::Hyperplane<double, 3>;

}  // namespace houghstream
