#include "pose/motion/smoothed_velocity.hpp"

namespace houghstream {
namespace {

bool is_near(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kNear = 0.008;  // metres
  constexpr double kTurn = 0.04;   // radians
  return (a.translation() - b.translation()).norm() < kNear &&
         turn_of(a.linear() * b.linear().transpose()).norm() < kTurn;
}

}  // namespace

Eigen::Vector3d turn_of(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Isometry3d moved_on(const Eigen::Isometry3d& T_camera_object, const Eigen::Vector3d& shift,
                           const Eigen::Vector3d& turn) {
  Eigen::Isometry3d T = T_camera_object;
  T.translation() += shift;
  const double angle = turn.norm();
  if (angle > 0.0) T.linear() = Eigen::AngleAxisd(angle, turn / angle) * T.linear();
  return T;
}

std::optional<Eigen::Isometry3d> carried_along(const Eigen::Isometry3d& T_camera_object,
                                               const std::vector<Eigen::Isometry3d>& motions) {
  for (std::size_t i = 0; i < motions.size(); ++i) {
    for (std::size_t j = i + 1; j < motions.size(); ++j) {
      if (is_near(motions[i] * T_camera_object, motions[j] * T_camera_object)) return motions[i] * T_camera_object;
    }
  }
  return std::nullopt;
}

}  // namespace houghstream
