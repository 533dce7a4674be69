#include "pipeline/geometry/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

Eigen::Vector3f corner_cross(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Eigen::Vector3f& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

std::vector<double> cumulative_areas(const Mesh& mesh) {
  std::vector<double> sums;
  sums.reserve(mesh.triangles.size());
  double sum = 0.0;
  for (const auto& t : mesh.triangles) sums.push_back(sum += 0.5 * static_cast<double>(corner_cross(mesh, t).norm()));
  return sums;
}

/// Independent points, uniform over the area.
SurfacePoints random_points(const Mesh& mesh, std::size_t count, std::uint64_t seed) {
  const std::vector<double> sums = cumulative_areas(mesh);
  require(!sums.empty() && sums.back() > 0.0, "mesh of {} triangles with surface area 0, expected a surface",
          mesh.triangles.size());
  Random random(seed);
  SurfacePoints out;
  for (std::size_t i = 0; i < count; ++i) {
    const double target = random.uniform() * sums.back();
    const auto found = std::upper_bound(sums.begin(), sums.end(), target);
    const auto& t = mesh.triangles[std::min<std::size_t>(found - sums.begin(), sums.size() - 1)];
    // Square root for uniform density over a triangle: Turk 1990, "Generating random points in triangles".
    const auto root = static_cast<float>(std::sqrt(random.uniform()));
    const auto along = static_cast<float>(random.uniform());
    out.points.emplace_back((1.0F - root) * mesh.vertices[t[0]] + root * (1.0F - along) * mesh.vertices[t[1]] +
                            root * along * mesh.vertices[t[2]]);
    out.normals.emplace_back(corner_cross(mesh, t).normalized());
  }
  return out;
}

}  // namespace

Eigen::AlignedBox3f mesh_bounds(const Mesh& mesh) {
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& vertex : mesh.vertices) bounds.extend(vertex);
  return bounds;
}

double mesh_diameter(const Mesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  // Farthest from the centre first: a pair can only beat the best one while its two radii add up to more.
  const Eigen::Vector3f centre = mesh_bounds(mesh).center();
  std::vector<std::pair<float, std::size_t>> by_radius;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) by_radius.emplace_back((mesh.vertices[i] - centre).norm(), i);
  std::sort(by_radius.begin(), by_radius.end(), std::greater<>());
  float best = 0.0F;
  for (std::size_t i = 0; i < by_radius.size() && 2.0F * by_radius[i].first >= best; ++i) {
    for (std::size_t j = i + 1; j < by_radius.size() && by_radius[i].first + by_radius[j].first >= best; ++j) {
      best = std::max(best, (mesh.vertices[by_radius[i].second] - mesh.vertices[by_radius[j].second]).norm());
    }
  }
  return best;
}

SurfacePoints sample_surface(const Mesh& mesh, int count, std::uint64_t seed) {
  require(count >= 1, "{} surface points asked for, expected at least 1", count);
  // Farthest-point choice (Eldar et al. 1997) among five times as many random points spreads them evenly.
  constexpr std::size_t kCandidatesPerPoint = 5;
  const SurfacePoints candidates = random_points(mesh, kCandidatesPerPoint * static_cast<std::size_t>(count), seed);
  std::vector<float> distance_sq(candidates.points.size(), std::numeric_limits<float>::infinity());
  SurfacePoints out;
  std::size_t chosen = 0;
  for (int n = 0; n < count; ++n) {
    out.points.push_back(candidates.points[chosen]);
    out.normals.push_back(candidates.normals[chosen]);
    for (std::size_t i = 0; i < distance_sq.size(); ++i) {
      distance_sq[i] = std::min(distance_sq[i], (candidates.points[i] - out.points.back()).squaredNorm());
    }
    chosen = std::max_element(distance_sq.begin(), distance_sq.end()) - distance_sq.begin();
  }
  return out;
}

}  // namespace houghstream
