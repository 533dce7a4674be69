#include "pose/motion/twist.hpp"

namespace houghstream {

Eigen::Isometry3d orthonormalised(const Eigen::Isometry3d& T) {
  Eigen::Isometry3d out = T;
  out.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return out;
}

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd rotation_step(rotation);
  return rotation_step.angle() * rotation_step.axis();
}

Vector6 local_coordinates_about_world(const Eigen::Isometry3d& T_to, const Eigen::Isometry3d& T_from) {
  const Eigen::AngleAxisd rotation_step(Eigen::Quaterniond(T_to.linear() * T_from.linear().transpose()).normalized());
  Vector6 twist;
  twist << T_to.translation() - T_from.translation(), rotation_step.angle() * rotation_step.axis();
  return twist;
}

Eigen::Isometry3d retract_about_world(const Eigen::Isometry3d& T, const Vector6& twist) {
  Eigen::Quaterniond q(T.linear());
  const double angle = twist.tail<3>().norm();
  if (angle > 0.0) q = Eigen::AngleAxisd(angle, twist.tail<3>() / angle) * q;
  return Eigen::Translation3d(T.translation() + twist.head<3>()) * q.normalized();
}

Eigen::Isometry3d interpolate_pose(const Eigen::Isometry3d& T_first, const Eigen::Isometry3d& T_second,
                                   double fraction) {
  return retract_about_world(T_first, fraction * local_coordinates_about_world(T_second, T_first));
}

Vector6 local_coordinates_about_body(const Eigen::Isometry3d& motion) {
  const Eigen::AngleAxisd rotation_step(motion.linear());
  Vector6 twist;
  twist << motion.translation(), rotation_step.angle() * rotation_step.axis();
  return twist;
}

Eigen::Isometry3d retract_about_body(const Eigen::Isometry3d& T, const Vector6& twist) {
  const double angle = twist.tail<3>().norm();
  Eigen::Isometry3d step = Eigen::Isometry3d::Identity();
  if (angle > 0.0) step.linear() = Eigen::AngleAxisd(angle, twist.tail<3>() / angle).toRotationMatrix();
  step.translation() = twist.head<3>();
  return orthonormalised(T * step);
}

Eigen::Isometry3d retract_about_point(const Eigen::Isometry3d& T, const Eigen::Vector3d& shift,
                                      const Eigen::Vector3d& rotation) {
  Eigen::Isometry3d out = T;
  out.translation() += shift;
  const double angle = rotation.norm();
  if (angle > 0.0) out.linear() = Eigen::AngleAxisd(angle, rotation / angle) * out.linear();
  return out;
}

}  // namespace houghstream
