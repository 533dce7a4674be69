#include "pose/motion/pose_covariance.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream {

Covariance6 measured_pose_covariance(const ObjectPose& pose, const Eigen::Isometry3d& T_world_camera,
                                     const ObjectExtent& extent) {
  constexpr double kAcross = 0.0015;  // metres a metre of distance, of an object of which all is seen
  constexpr double kAlong = 0.002;
  constexpr double kMinRotation = 0.008;  // radians
  const Eigen::Vector3d ray = *pose.T_camera_object * extent.centre;
  const double distance = std::max(0.3, ray.norm());
  const double unclear = 1.0 / std::sqrt(std::clamp(static_cast<double>(pose.visible_fraction), 0.1, 1.0));
  const double across = kAcross * distance * unclear;
  const double along = kAlong * distance * distance * unclear;
  const double angle_rad = kMinRotation + across / std::max(0.02, extent.radius_m);
  const Eigen::Vector3d direction = T_world_camera.linear() * ray.normalized();
  const Eigen::Matrix3d beam = direction * direction.transpose();
  Covariance6 out = Covariance6::Zero();
  out.topLeftCorner<3, 3>() = across * across * (Eigen::Matrix3d::Identity() - beam) + along * along * beam;
  out.bottomRightCorner<3, 3>().diagonal().setConstant(angle_rad * angle_rad);
  return out;
}

}  // namespace houghstream
