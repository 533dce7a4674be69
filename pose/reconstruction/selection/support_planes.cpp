#include "pose/reconstruction/selection/support_planes.hpp"

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

double plane_limit_at(const Eigen::Vector3d& point) {
  return plane_distance_limit(point.z());
}

/// Returns the precision of a point's measurement.
double precision_at(const Eigen::Vector3d& point) {
  return 1.0 / (depth_sigma(point.z()) * depth_sigma(point.z()));
}

/// Returns whether a plane can support objects: a camera held upright looks down on a table, or straight down.
bool can_support(const Plane& plane) {
  return plane.offset() > 0.08 && (-plane.normal().y() > 0.2 || -plane.normal().z() > 0.8);
}

}  // namespace

std::vector<Plane> find_planes(const RgbdFrame& frame, double max_distance_m, std::uint64_t seed) {
  constexpr int kMax = 5;
  constexpr PlaneSearch kSearch{400, 1500, 1e-3};
  std::vector<Eigen::Vector3d> points = scattered_points(frame, max_distance_m);
  const auto min_count = std::max<std::size_t>(150, points.size() / 15);
  Random random(seed);
  std::vector<Plane> planes;
  for (int i = 0; i < kMax && points.size() > min_count; ++i) {
    std::optional<Plane> plane = find_largest_plane(points, plane_limit_at, kSearch, random);
    if (!plane) break;
    for (int again = 0; again < 2; ++again) {
      const std::vector<Eigen::Vector3d> inliers = points_on(*plane, points, plane_limit_at);
      if (inliers.size() < min_count) return planes;
      plane = fit_plane(inliers, precision_at);
    }
    if (can_support(*plane)) planes.push_back(*plane);
    points.erase(std::remove_if(points.begin(), points.end(),
                                [&](const Eigen::Vector3d& p) {
                                  return plane->absDistance(p) < 2.0 * plane_distance_limit(p.z());
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
        if (refined.absDistance(p) < plane_distance_limit(z) && (p - middle).norm() < radius_m) points.push_back(p);
      }
    }
    if (points.size() < kMin) return plane;
    refined = fit_plane(points, precision_at);
  }
  return refined;
}

}  // namespace houghstream::reconstruction
