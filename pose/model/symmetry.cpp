#include "pose/model/symmetry.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

Eigen::Isometry3d rotate_about(const Eigen::Quaterniond& rotation_step, const Eigen::Vector3d& offset) {
  return Eigen::Translation3d(offset) * rotation_step * Eigen::Translation3d(-offset);
}

/// Returns the cosine of half the angle of a rotation.
double nearness(const Eigen::Quaterniond& rotation) {
  return std::abs(rotation.w());
}

/// Returns the rotation about `axis` after which the remaining angle of `rotation` is minimal: its twist (swing-twist
/// decomposition), backwards.
Eigen::Quaterniond untwist(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& axis) {
  const double along = rotation.vec().dot(axis);
  const double norm = std::hypot(rotation.w(), along);
  constexpr double kNoTwist = 1e-9;  // half a turn about a perpendicular axis: every rotation leaves as much
  if (norm < kNoTwist) return Eigen::Quaterniond::Identity();
  const Eigen::Vector3d back = -along / norm * axis;
  return {rotation.w() / norm, back.x(), back.y(), back.z()};
}

bool is_ball(const Symmetries& symmetries) {
  constexpr double kParallel = 0.999;
  const auto& axes = symmetries.continuous;
  return std::any_of(axes.begin(), axes.end(), [&](const ContinuousSymmetry& other) {
    return std::abs(other.axis.dot(axes.front().axis)) < kParallel;
  });
}

/// Returns the best symmetry among the rotations about the axis, if there is one, each after `discrete`.
Eigen::Isometry3d best_after(const Eigen::Isometry3d& discrete, const Eigen::Quaterniond& R_reference_object,
                             const Symmetries& symmetries) {
  if (symmetries.continuous.empty()) return discrete;
  const ContinuousSymmetry& rotations = symmetries.continuous.front();
  // The angle of R C D is that of D R C, because D (.) D^-1 keeps angles.
  const Eigen::Quaterniond conjugated = Eigen::Quaterniond(discrete.linear()) * R_reference_object;
  return rotate_about(untwist(conjugated, rotations.axis), rotations.offset) * discrete;
}

}  // namespace

std::vector<Eigen::Isometry3d> expand_symmetries(const Symmetries& symmetries, double max_step) {
  require(max_step > 0.0, "symmetries: step of {} diameters, expected above 0", max_step);
  std::vector<Eigen::Isometry3d> rotations;
  // A point at most half a diameter from the axis goes pi diameters in a full turn.
  const int steps = static_cast<int>(std::ceil(M_PI / max_step));
  for (const ContinuousSymmetry& symmetry : symmetries.continuous) {
    for (int i = rotations.empty() ? 0 : 1; i < steps; ++i) {
      rotations.push_back(rotation_about(symmetry, 2.0 * M_PI * i / steps));
    }
  }
  if (rotations.empty()) rotations.push_back(Eigen::Isometry3d::Identity());
  std::vector<Eigen::Isometry3d> all = rotations;
  for (const Eigen::Isometry3d& discrete : symmetries.discrete) {
    for (const Eigen::Isometry3d& rotation_step : rotations) all.emplace_back(rotation_step * discrete);
  }
  return all;
}

Eigen::Isometry3d rotation_about(const ContinuousSymmetry& symmetry, double angle_rad) {
  return rotate_about(Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, symmetry.axis)), symmetry.offset);
}

Eigen::Isometry3d symmetry_towards(const Eigen::Quaterniond& R_camera_object, const Eigen::Quaterniond& R_reference,
                                   const Symmetries& symmetries) {
  const Eigen::Quaterniond R_reference_object = R_reference.conjugate() * R_camera_object;
  if (is_ball(symmetries)) return rotate_about(R_reference_object.conjugate(), symmetries.continuous.front().offset);
  Eigen::Isometry3d best = best_after(Eigen::Isometry3d::Identity(), R_reference_object, symmetries);
  const auto left_by = [&](const Eigen::Isometry3d& symmetry) {
    return nearness(R_reference_object * Eigen::Quaterniond(symmetry.linear()));
  };
  constexpr double kTie = 1e-9;
  for (const Eigen::Isometry3d& discrete : symmetries.discrete) {
    const Eigen::Isometry3d candidate = best_after(discrete, R_reference_object, symmetries);
    if (left_by(candidate) > left_by(best) + kTie) best = candidate;
  }
  return best;
}

Eigen::Quaterniond nearest_equivalent(const Eigen::Quaterniond& R_camera_object, const Eigen::Quaterniond& R_reference,
                                      const Symmetries& symmetries) {
  const Eigen::Isometry3d symmetry = symmetry_towards(R_camera_object, R_reference, symmetries);
  return (R_camera_object * Eigen::Quaterniond(symmetry.linear())).normalized();
}

Eigen::Isometry3d nearest_equivalent(const Eigen::Isometry3d& T_camera_object, const Eigen::Isometry3d& T_reference,
                                     const Symmetries& symmetries) {
  return T_camera_object * symmetry_towards(Eigen::Quaterniond(T_camera_object.linear()),
                                            Eigen::Quaterniond(T_reference.linear()), symmetries);
}

}  // namespace houghstream
