#include "pose/reconstruction/selection/support_planes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "pipeline/base/random.hpp"
#include "pose/reconstruction/map/frame_levels.hpp"

namespace houghstream::reconstruction {
namespace {

double plane_distance_limit(double z) {
  return 0.004 + 2.0 * depth_sigma(z);
}

std::vector<Eigen::Vector3d> scattered_points(const RgbdFrame& frame, double max_distance_m) {
  constexpr int kStep_px = 4;
  std::vector<Eigen::Vector3d> points;
  for (int y = kStep_px / 2; y < frame.depth.rows; y += kStep_px) {
    for (int x = kStep_px / 2; x < frame.depth.cols; x += kStep_px) {
      const float z = frame.depth.at<float>(y, x);
      if (z > 0.15F && z < max_distance_m) points.push_back(frame.camera.backproject(x, y, z));
    }
  }
  return points;
}

Plane towards_camera(const Eigen::Vector3d& normal, double offset) {
  if (offset < 0.0) return {-normal, -offset};
  return {normal, offset};
}

/// Fits by least squares through points, weighted by the precision of their measurement.
Plane fit_plane(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double weights = 0.0;
  const auto weight_of = [](const Eigen::Vector3d& p) { return 1.0 / (depth_sigma(p.z()) * depth_sigma(p.z())); };
  for (const Eigen::Vector3d& p : points) {
    mean += weight_of(p) * p;
    weights += weight_of(p);
  }
  mean /= weights;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) squares += weight_of(p) * (p - mean) * (p - mean).transpose();
  const Eigen::Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares).eigenvectors().col(0);
  return towards_camera(normal, -normal.dot(mean));
}

std::vector<Eigen::Vector3d> inliers_of(const Plane& plane, const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3d> inliers;
  for (const Eigen::Vector3d& p : points) {
    if (std::abs(plane.height(p)) < plane_distance_limit(p.z())) inliers.push_back(p);
  }
  return inliers;
}

std::optional<Plane> largest_plane(const std::vector<Eigen::Vector3d>& points, Random& random) {
  constexpr int kTrials = 400;
  constexpr std::size_t kCounted = 1500;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kCounted);
  std::optional<Plane> best;
  int maximum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto pick = [&] { return points[static_cast<std::size_t>(random.below(static_cast<int>(points.size())))]; };
    const Eigen::Vector3d a = pick();
    const Eigen::Vector3d b = pick();
    const Eigen::Vector3d c = pick();
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    if (normal.norm() < 1e-3) continue;
    const Plane plane = towards_camera(normal.normalized(), -normal.normalized().dot(a));
    int count = 0;
    for (std::size_t i = 0; i < points.size(); i += step)
      count += std::abs(plane.height(points[i])) < plane_distance_limit(points[i].z()) ? 1 : 0;
    if (count <= maximum) continue;
    maximum = count;
    best = plane;
  }
  return best;
}

/// Returns whether a plane may carry objects: a camera held upright looks down on a table, or straight down.
bool may_carry(const Plane& plane) {
  return plane.offset > 0.08 && (-plane.normal.y() > 0.2 || -plane.normal.z() > 0.8);
}

}  // namespace

std::vector<Plane> find_planes(const RgbdFrame& frame, double max_distance_m, std::uint64_t seed) {
  constexpr int kMax = 5;
  std::vector<Eigen::Vector3d> points = scattered_points(frame, max_distance_m);
  const auto min_count = std::max<std::size_t>(150, points.size() / 15);
  Random random(seed);
  std::vector<Plane> planes;
  for (int i = 0; i < kMax && points.size() > min_count; ++i) {
    std::optional<Plane> plane = largest_plane(points, random);
    if (!plane) break;
    for (int again = 0; again < 2; ++again) {
      const std::vector<Eigen::Vector3d> inliers = inliers_of(*plane, points);
      if (inliers.size() < min_count) return planes;
      plane = fit_plane(inliers);
    }
    if (may_carry(*plane)) planes.push_back(*plane);
    points.erase(std::remove_if(points.begin(), points.end(),
                                [&](const Eigen::Vector3d& p) {
                                  return std::abs(plane->height(p)) < 2.0 * plane_distance_limit(p.z());
                                }),
                 points.end());
  }
  return planes;
}

Plane refine_plane(const RgbdFrame& frame, const cv::Mat& mask, const Plane& plane, const Eigen::Vector3d& middle,
                   double radius_m) {
  constexpr std::size_t kMin = 200;
  Plane refined = plane;
  for (int again = 0; again < 3; ++again) {
    std::vector<Eigen::Vector3d> points;
    for (int y = 1; y < frame.depth.rows; y += 2) {
      for (int x = 1; x < frame.depth.cols; x += 2) {
        const float z = frame.depth.at<float>(y, x);
        if (!(z > 0.1F) || (!mask.empty() && mask.at<std::uint8_t>(y, x) != 0)) continue;
        const Eigen::Vector3d p = frame.camera.backproject(x, y, z);
        if (std::abs(refined.height(p)) < plane_distance_limit(z) && (p - middle).norm() < radius_m)
          points.push_back(p);
      }
    }
    if (points.size() < kMin) return plane;
    refined = fit_plane(points);
  }
  return refined;
}

}  // namespace houghstream::reconstruction
