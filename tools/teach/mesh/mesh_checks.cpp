#include "tools/teach/mesh/mesh_checks.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "pose/model/mesh_bvh.hpp"
#include "tools/common/mesh_size.hpp"

namespace houghstream::teach {
namespace {

void require_size(const std::string& where, double unit_m, const Mesh& mesh) {
  const std::string fault = mesh_size_error(mesh_diameter(mesh), unit_m, "--unit");
  require(fault.empty(), "{}: {}", where, fault);
}

/// Refuses a mesh far from its origin, as CAD in an assembly's coordinates may be.
void require_near_origin(const std::string& where, const Mesh& mesh) {
  const float away = mesh_bounds(mesh).center().norm();
  require(away < store::kMaxCentre_m,
          "{}: its middle lies {:.4g} m from the origin of its coordinates, expected less than {:.0f} m", where, away,
          store::kMaxCentre_m);
}

/// Vertices at one place have one number: where texture is cut, the surface is not.
std::vector<std::uint32_t> weld(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto key = [&](std::uint32_t i) {
    const Eigen::Vector3f& v = mesh.vertices[i];
    return std::array<float, 3>{v.x(), v.y(), v.z()};
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  std::vector<std::uint32_t> welded(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    welded[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? welded[order[i - 1]] : order[i];
  return welded;
}

/// Topology of a surface.
struct Topology {
  double open_m = 0.0;      ///< length of edges that one face has alone
  std::size_t edges = 0;    ///< number of edges between two faces
  std::size_t against = 0;  ///< number of these between two faces of opposite winding
  double volume_m3 = 0.0;   ///< signed, about the middle of the bounding box; negative where faces look inwards
  double box_volume_m3 = 0.0;
};

Topology examine(const Mesh& mesh) {
  using Edge = std::pair<std::pair<std::uint32_t, std::uint32_t>, int>;
  const std::vector<std::uint32_t> welded = weld(mesh);
  const Eigen::AlignedBox3d box = mesh_bounds(mesh).cast<double>();
  Topology found;
  found.box_volume_m3 = box.volume();
  std::vector<Edge> edges;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t k) -> Eigen::Vector3d { return mesh.vertices[t[k]].cast<double>() - box.center(); };
    found.volume_m3 += at(0).dot(at(1).cross(at(2))) / 6.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = welded[t[k]];
      const std::uint32_t b = welded[t[(k + 1) % 3]];
      if (a != b) edges.push_back({{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first;
    int direction = 0;
    for (; last < edges.size() && edges[last].first == edges[first].first; ++last) direction += edges[last].second;
    const auto& [a, b] = edges[first].first;
    if (last - first == 1) found.open_m += static_cast<double>((mesh.vertices[a] - mesh.vertices[b]).norm());
    if (last - first == 2) {
      ++found.edges;
      found.against += direction != 0 ? 1 : 0;
    }
    first = last;
  }
  return found;
}

void flip_faces(Mesh& mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

/// Returns the fraction of the surface whose normals look to the side from which its faces are counter-clockwise.
double agreement(const Mesh& mesh) {
  double agreeing = 0.0;
  double all = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[t[0]];
    const Eigen::Vector3f face = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    const Eigen::Vector3f normal = mesh.normals[t[0]] + mesh.normals[t[1]] + mesh.normals[t[2]];
    const auto area = static_cast<double>(face.norm());
    all += area;
    if (face.dot(normal) >= 0.0F) agreeing += area;
  }
  return all > 0.0 ? agreeing / all : 1.0;
}

/// Returns the largest distance from the surface that the motion gives one of its points.
double max_distance(const std::vector<Eigen::Vector3f>& points, const MeshBvh& tree, const Eigen::Isometry3d& motion) {
  float largest = 0.0F;
  for (const Eigen::Vector3f& point : points)
    largest = std::max(largest, tree.nearest((motion * point.cast<double>()).cast<float>()).distance);
  return static_cast<double>(largest);
}

}  // namespace

void check_mesh(const std::string& where, double unit_m, Mesh& mesh) {
  require_size(where, unit_m, mesh);
  require_near_origin(where, mesh);
  const Topology found = examine(mesh);
  constexpr double kMinVolume = 1e-3;  // fraction of the box's volume: below it, a plate has no inside
  if (found.volume_m3 < -kMinVolume * found.box_volume_m3) {
    flip_faces(mesh);
    log_warning("{}: the surface faces inwards (volume {:.4g} cm3), expected outwards: turned around", where,
                found.volume_m3 * 1e6);
  }
  constexpr double kAgreeing = 0.9;
  const double agreeing = agreement(mesh);
  if (agreeing < kAgreeing) {
    compute_normals(mesh);
    log_warning("{}: {:.0f} % of the normals face inwards, expected none: made anew from the faces", where,
                100.0 * (1.0 - agreeing));
  }
  constexpr double kOpen = 0.25;  // fraction of the diameter: less are cracks
  if (found.open_m > kOpen * mesh_diameter(mesh))
    log_warning("{}: open edges of {:.3g} m in all, expected a closed surface: taught as it is", where, found.open_m);
  constexpr std::size_t kAgainst = 100;  // one of so many
  if (found.against * kAgainst > found.edges)
    log_warning("{}: {} of {} neighbouring faces are wound against each other, expected none: taught as it is", where,
                found.against, found.edges);
}

void check_symmetries(const std::string& where, const Mesh& mesh, const Symmetries& symmetries) {
  if (symmetries.empty()) return;
  constexpr int kPoints = 500;
  constexpr double kSteps = 12.0;  // steps of a full turn
  const double allowed = std::max(0.015, 0.1 * mesh_diameter(mesh));
  const MeshBvh tree(mesh);
  const std::vector<Eigen::Vector3f> points = sample_surface(mesh, kPoints, 1).points;
  const auto check = [&](const std::string& which, const Eigen::Isometry3d& motion) {
    const double off = max_distance(points, tree, motion);
    require(off <= allowed,
            "{}: {} takes points of the mesh up to {:.1f} mm off its surface, expected at most {:.1f} mm", where, which,
            off * 1e3, allowed * 1e3);
  };
  for (std::size_t i = 0; i < symmetries.discrete.size(); ++i)
    check(fmt::format("symmetries_discrete {}", i), symmetries.discrete[i]);
  for (std::size_t i = 0; i < symmetries.continuous.size(); ++i) {
    const auto& [axis, offset] = symmetries.continuous[i];
    for (double step = 1.0; step < kSteps; step += 1.0) {
      Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
      motion.translate(offset).rotate(Eigen::AngleAxisd(2.0 * M_PI * step / kSteps, axis)).translate(-offset);
      check(fmt::format("symmetries_continuous {}", i), motion);
    }
  }
}

bool has_colour(const Mesh& mesh) {
  constexpr int kSame = 4;   // difference of 255 that a JPEG makes
  constexpr int kGrey = 10;  // difference of 255 between the channels
  cv::Mat pixels;
  if (!mesh.texture.empty()) {
    pixels = mesh.texture;
  } else if (mesh.colours.size() == mesh.vertices.size() && !mesh.colours.empty()) {
    pixels = cv::Mat(mesh.colours, true);
  } else {
    return false;
  }
  std::vector<cv::Mat> channels;
  cv::split(pixels, channels);
  double brightest = 0.0;
  double darkest = 255.0;
  for (const cv::Mat& channel : channels) {
    double low = 0.0;
    double high = 0.0;
    cv::minMaxLoc(channel, &low, &high);
    if (high - low > 2 * kSame) return true;
    brightest = std::max(brightest, high);
    darkest = std::min(darkest, low);
  }
  return brightest - darkest > kGrey + 2 * kSame;
}

}  // namespace houghstream::teach
