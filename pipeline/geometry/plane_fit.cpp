#include "pipeline/geometry/plane_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstddef>

namespace houghstream {
namespace {

Plane towards_origin(const Eigen::Vector3d& normal, double offset) {
  return offset < 0.0 ? Plane(-normal, -offset) : Plane(normal, offset);
}

}  // namespace

std::optional<Plane> find_largest_plane(const std::vector<Eigen::Vector3d>& points, const ValueOfPoint& limit_m,
                                        const PlaneSearch& search, Random& random) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / static_cast<std::size_t>(search.max_counted));
  const auto any_point = [&] {
    return points[static_cast<std::size_t>(random.below(static_cast<int>(points.size())))];
  };
  std::optional<Plane> best;
  int maximum = 0;
  for (int trial = 0; trial < search.trials; ++trial) {
    const Eigen::Vector3d a = any_point();
    const Eigen::Vector3d b = any_point();
    const Eigen::Vector3d c = any_point();
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (!(normal.norm() > search.min_cross_m2)) continue;
    const Plane plane = towards_origin(normal.normalized(), -normal.normalized().dot(a));
    int count = 0;
    for (std::size_t i = 0; i < points.size(); i += step)
      count += plane.absDistance(points[i]) < limit_m(points[i]) ? 1 : 0;
    if (count <= maximum) continue;
    maximum = count;
    best = plane;
  }
  return best;
}

std::vector<Eigen::Vector3d> points_on(const Plane& plane, const std::vector<Eigen::Vector3d>& points,
                                       const ValueOfPoint& limit_m) {
  std::vector<Eigen::Vector3d> on;
  for (const Eigen::Vector3d& point : points) {
    if (plane.absDistance(point) < limit_m(point)) on.push_back(point);
  }
  return on;
}

Plane fit_plane(const std::vector<Eigen::Vector3d>& points, const ValueOfPoint& weight) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double weights = 0.0;
  for (const Eigen::Vector3d& point : points) {
    mean += weight(point) * point;
    weights += weight(point);
  }
  mean /= weights;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) scatter += weight(point) * (point - mean) * (point - mean).transpose();
  const Eigen::Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  return towards_origin(normal, -normal.dot(mean));
}

}  // namespace houghstream
