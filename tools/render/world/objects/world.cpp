#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {

Camera synthetic_camera() {
  return {640, 480, 525.0, 525.0, 319.5, 239.5};
}

Eigen::Isometry3d look_at(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& target_world) {
  const Eigen::Vector3d forward = (target_world - eye_world).normalized();
  Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ());
  if (right.norm() < 1e-6) right = Eigen::Vector3d::UnitX();  // straight down: any right will do
  right.normalize();
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  T_camera_world.linear().row(0) = right;
  T_camera_world.linear().row(1) = forward.cross(right);
  T_camera_world.linear().row(2) = forward;
  T_camera_world.translation() = -(T_camera_world.linear() * eye_world);
  return T_camera_world;
}

}  // namespace houghstream::world
