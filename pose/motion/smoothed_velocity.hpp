#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace houghstream {

/// A rotation as axis times angle, radians.
Eigen::Vector3d turn_of(const Eigen::Matrix3d& rotation);

/// The pose shifted (metres) and turned about its origin (axis times radians), both in the camera's frame.
Eigen::Isometry3d moved_on(const Eigen::Isometry3d& T_camera_object, const Eigen::Vector3d& shift,
                           const Eigen::Vector3d& turn);

/// Where the motion that two of these agree on (8 mm, 0.04 radians, at this pose) would bring it: the camera's own, as
/// far as it can be told. Motions are of the camera's frame: T_after * T_before^-1 of other objects. Nothing where no
/// two agree.
std::optional<Eigen::Isometry3d> carried_along(const Eigen::Isometry3d& T_camera_object,
                                               const std::vector<Eigen::Isometry3d>& motions);

}  // namespace houghstream
