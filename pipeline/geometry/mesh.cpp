#include "pipeline/geometry/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
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

/// Returns independent points, uniform over the area.
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
    // The square root gives uniform density over a triangle (Turk 1990, "Generating random points in triangles").
    const auto root = static_cast<float>(std::sqrt(random.uniform()));
    const auto along = static_cast<float>(random.uniform());
    out.points.emplace_back((1.0F - root) * mesh.vertices[t[0]] + root * (1.0F - along) * mesh.vertices[t[1]] +
                            root * along * mesh.vertices[t[2]]);
    out.normals.emplace_back(corner_cross(mesh, t).normalized());
  }
  return out;
}

/// Distance of each point from the nearest chosen one, stored coordinate by coordinate, so that several are processed
/// at once.
class FarthestPoints {
 public:
  explicit FarthestPoints(const std::vector<Eigen::Vector3f>& points)
      : groups_((points.size() + kLanes - 1) / kLanes), size_(points.size()) {
    for (std::size_t i = 0; i < groups_.size() * kLanes; ++i) {
      Group& group = groups_[i / kLanes];
      const auto lane = static_cast<Eigen::Index>(i % kLanes);
      const Eigen::Vector3f& point = points[std::min(i, size_ - 1)];
      group.x[lane] = point.x();
      group.y[lane] = point.y();
      group.z[lane] = point.z();
      group.distance_sq[lane] = std::numeric_limits<float>::infinity();
    }
  }

  /// The first of those that are farthest once this one is chosen too.
  std::size_t max_with(const Eigen::Vector3f& selected) {
    Lanes farthest = Lanes::Zero();
    for (Group& group : groups_) {
      const Lanes x = group.x - selected.x();
      const Lanes y = group.y - selected.y();
      const Lanes z = group.z - selected.z();
      group.distance_sq = group.distance_sq.min(x * x + (y * y + z * z));
      farthest = farthest.max(group.distance_sq);
    }
    const float maximum = farthest.maxCoeff();
    std::size_t i = 0;
    while (i + 1 < size_ && groups_[i / kLanes].distance_sq[static_cast<Eigen::Index>(i % kLanes)] != maximum) ++i;
    return i;
  }

 private:
  static constexpr int kLanes = 8;
  using Lanes = Eigen::Array<float, kLanes, 1>;
  struct Group {
    Lanes x, y, z, distance_sq;
  };
  std::vector<Group> groups_;
  std::size_t size_;
};

}  // namespace

Eigen::AlignedBox3f mesh_bounds(const Mesh& mesh) {
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& vertex : mesh.vertices) bounds.extend(vertex);
  return bounds;
}

double mesh_diameter(const Mesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  // The vertices farthest from the centre come first: a pair can only beat the best one while its two radii add up to
  // more.
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

void remove_colour(Mesh& mesh) {
  mesh.texture.release();
  mesh.uvs.clear();
  mesh.colours.clear();
}

SurfacePoints sample_surface(const Mesh& mesh, int count, std::uint64_t seed) {
  require(count >= 1, "{} surface points asked for, expected at least 1", count);
  // Farthest-point selection (Eldar et al. 1997) among five times as many random points spreads them evenly.
  constexpr std::size_t kCandidatesPerPoint = 5;
  const SurfacePoints candidates = random_points(mesh, kCandidatesPerPoint * static_cast<std::size_t>(count), seed);
  FarthestPoints distances(candidates.points);
  SurfacePoints out;
  std::size_t selected = 0;
  for (int n = 0; n < count; ++n) {
    out.points.push_back(candidates.points[selected]);
    out.normals.push_back(candidates.normals[selected]);
    selected = distances.max_with(out.points.back());
  }
  return out;
}

}  // namespace houghstream
