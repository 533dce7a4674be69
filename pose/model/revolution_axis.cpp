#include "pose/model/revolution_axis.hpp"

#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

using Vector4 = Eigen::Matrix<double, 4, 1>;
using Matrix4 = Eigen::Matrix<double, 4, 4>;
using AcrossBasis = Eigen::Matrix<double, 3, 2>;  // two unit vectors across an axis, as columns

/// Holds a surface point relative to the centre, with its normal.
struct OrientedPoint {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
};

/// An axis with how well the surface fits it.
struct ScoredAxis {
  Eigen::Vector3d direction;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< relative to the centre, across the direction
  double score = 0.0;                                ///< weighted fraction of the surface that fits, 0 to 1
};

AcrossBasis plane_across(const Eigen::Vector3d& direction) {
  AcrossBasis plane;
  plane.col(0) = direction.unitOrthogonal();
  plane.col(1) = direction.cross(plane.col(0));
  return plane;
}

/// Returns the distance, metres, by which the point's surface leaves itself per radian of rotation about the axis.
double rotation_residual(const OrientedPoint& p, const ScoredAxis& axis) {
  return p.normal.dot(axis.direction.cross(p.point - axis.offset));
}

class RevolutionFit {
 public:
  RevolutionFit(const SurfacePoints& surface, const Eigen::Vector3d& centre, double sigma_m) : sigma_m_(sigma_m) {
    for (std::size_t i = 0; i < surface.points.size(); ++i)
      points_.push_back({surface.points[i].cast<double>() - centre, surface.normals[i].cast<double>()});
  }

  /// Runs Gauss-Newton steps with reweighting; the direction stays as it is where `with_direction` is false.
  void improve(int iterations, bool with_direction, ScoredAxis& axis) const {
    for (int i = 0; i < iterations; ++i) step(with_direction, axis);
    axis.score = score(axis);
  }

 private:
  double kernel(double r) const {
    const double ratio = r / sigma_m_;
    return 1.0 / (1.0 + ratio * ratio);
  }

  void step(bool with_direction, ScoredAxis& axis) const {
    const AcrossBasis plane = plane_across(axis.direction);
    Matrix4 normal_matrix = Matrix4::Zero();
    Vector4 right_side = Vector4::Zero();
    for (const OrientedPoint& p : points_) {
      const double r = rotation_residual(p, axis);
      const double weight = kernel(r) * kernel(r);
      Vector4 jacobian;
      jacobian.head<2>() = -plane.transpose() * p.normal.cross(axis.direction);
      jacobian.tail<2>() = plane.transpose() * (p.point - axis.offset).cross(p.normal);
      if (!with_direction) jacobian.tail<2>().setZero();
      normal_matrix += weight * jacobian * jacobian.transpose();
      right_side -= weight * r * jacobian;
    }
    // The system is damped, so that what no normal determines, such as the position of an axis across a plane, stays.
    constexpr double kDamping = 1e-6;
    normal_matrix.diagonal().head<2>().array() += kDamping * static_cast<double>(points_.size());
    normal_matrix.diagonal().tail<2>().array() += kDamping * static_cast<double>(points_.size()) * sigma_m_ * sigma_m_;
    const Vector4 change = normal_matrix.ldlt().solve(right_side);
    axis.offset += plane * change.head<2>();
    axis.direction = (axis.direction + plane * change.tail<2>()).normalized();
    axis.offset -= axis.direction.dot(axis.offset) * axis.direction;
  }

  /// Returns the score of an axis. A surface across the axis fits every axis of its direction, and is not counted.
  double score(const ScoredAxis& axis) const {
    double fitting = 0.0;
    double total = 0.0;
    for (const OrientedPoint& p : points_) {
      const double weight = p.normal.cross(axis.direction).norm();
      fitting += weight * kernel(rotation_residual(p, axis));
      total += weight;
    }
    return total > 0.0 ? fitting / total : 0.0;
  }

  std::vector<OrientedPoint> points_;
  double sigma_m_;
};

/// Returns the best axes, no two of them within 20 degrees of one another.
std::vector<ScoredAxis> best_apart(std::vector<ScoredAxis> axes, std::size_t count) {
  constexpr double kSameDirection = 0.94;  // cosine of 20 degrees
  std::stable_sort(axes.begin(), axes.end(),
                   [](const ScoredAxis& a, const ScoredAxis& b) { return a.score > b.score; });
  std::vector<ScoredAxis> best;
  for (const ScoredAxis& axis : axes) {
    const auto is_near = [&](const ScoredAxis& known) {
      return std::abs(known.direction.dot(axis.direction)) > kSameDirection;
    };
    if (best.size() < count && std::none_of(best.begin(), best.end(), is_near)) best.push_back(axis);
  }
  return best;
}

}  // namespace

std::vector<Eigen::Vector3d> hemisphere_directions(int count) {
  const double golden_angle_rad = M_PI * (3.0 - std::sqrt(5.0));
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < count; ++i) {
    const double z = (i + 0.5) / count;
    const double across = std::sqrt(1.0 - z * z);
    directions.emplace_back(across * std::cos(golden_angle_rad * i), across * std::sin(golden_angle_rad * i), z);
  }
  return directions;
}

std::vector<ContinuousSymmetry> find_revolution_axes(const SurfacePoints& surface, const Eigen::Vector3d& centre,
                                                     double sigma_m) {
  constexpr int kDirections = 150;  // 12 degrees apart
  constexpr int kSteps = 5;
  constexpr int kFinalSteps = 15;
  constexpr std::size_t kAxes = 4;
  const RevolutionFit fit(surface, centre, sigma_m);
  std::vector<ScoredAxis> axes;
  for (const Eigen::Vector3d& direction : hemisphere_directions(kDirections)) {
    axes.push_back({direction});
    fit.improve(kSteps, false, axes.back());
  }
  axes = best_apart(std::move(axes), kAxes);
  for (ScoredAxis& axis : axes) fit.improve(kFinalSteps, true, axis);
  std::vector<ContinuousSymmetry> found;
  for (const ScoredAxis& axis : best_apart(std::move(axes), kAxes))
    found.push_back({axis.direction, centre + axis.offset});
  return found;
}

}  // namespace houghstream
