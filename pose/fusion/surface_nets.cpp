#include "pose/fusion/surface_nets.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <unordered_map>

#include "pipeline/geometry/mesh_part.hpp"

namespace houghstream::fusion {
namespace {

using Cell = std::array<int, 3>;  // its lowest corner is the voxel of the same indices; -1 = outside the grid

/// Cells and vertices by slices of cells, so that every vertex is found again by its cell.
class SurfaceNet {
 public:
  explicit SurfaceNet(const TsdfVolume& grid) : grid_(grid) {}

  Mesh extract() {
    for (int k = 0; k < grid_.nz; ++k) {
      for (int j = 0; j < grid_.ny; ++j) {
        for (int i = 0; i < grid_.nx; ++i) {
          for (int axis = 0; axis < 3; ++axis) add_face({i, j, k}, axis);
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  float at(const Cell& c) const {
    const bool within =
        c[0] > 0 && c[1] > 0 && c[2] > 0 && c[0] < grid_.nx - 1 && c[1] < grid_.ny - 1 && c[2] < grid_.nz - 1;
    return within ? grid_.distance[grid_.index(c[0], c[1], c[2])] : 1.0F;
  }

  /// Adds the face across the edge from voxel `c` to the next along `axis`, where one is inside and one outside.
  void add_face(const Cell& c, int axis) {
    Cell next = c;
    ++next[axis];
    const bool from_inside = at(c) < 0.0F;
    if (from_inside == (at(next) < 0.0F)) return;
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    std::array<std::uint32_t, 4> corners{};
    constexpr std::array<std::array<int, 2>, 4> kRound = {{{-1, -1}, {0, -1}, {0, 0}, {-1, 0}}};
    for (std::size_t n = 0; n < 4; ++n) {
      Cell cell = c;
      cell[u] += kRound[n][0];
      cell[v] += kRound[n][1];
      corners[n] = vertex_of(cell);
    }
    if (!from_inside) std::swap(corners[1], corners[3]);
    mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
    mesh_.triangles.push_back({corners[0], corners[2], corners[3]});
  }

  std::uint32_t vertex_of(const Cell& cell) {
    const auto [found, is_new] =
        vertices_.try_emplace(grid_.index(cell[0], cell[1], cell[2]), static_cast<std::uint32_t>(vertices_.size()));
    if (is_new) mesh_.vertices.push_back(mean_crossing(cell));
    return found->second;
  }

  Eigen::Vector3f mean_crossing(const Cell& cell) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int corner = 0; corner < 4; ++corner) {
        Cell a = cell;
        a[(axis + 1) % 3] += corner & 1;
        a[(axis + 2) % 3] += corner >> 1;
        Cell b = a;
        ++b[axis];
        const double da = at(a);
        const double db = at(b);
        if ((da < 0.0) == (db < 0.0)) continue;
        Eigen::Vector3d crossing(a[0], a[1], a[2]);
        crossing[axis] += da / (da - db);
        sum += crossing;
        ++count;
      }
    }
    return (grid_.origin + grid_.voxel * sum / count).cast<float>();
  }

  const TsdfVolume& grid_;
  Mesh mesh_;
  std::unordered_map<std::size_t, std::uint32_t> vertices_;  // index of the vertex, by cell
};

/// The part that each vertex belongs to, named by one of its vertices.
class Parts {
 public:
  explicit Parts(std::size_t vertices) : parent_(vertices) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t find(std::uint32_t vertex) {
    while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

Mesh extract_surface(const TsdfVolume& grid) {
  Mesh mesh = SurfaceNet(grid).extract();
  compute_normals(mesh);
  return mesh;
}

Mesh largest_part(const Mesh& mesh) {
  Parts parts(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    parts.join(t[0], t[1]);
    parts.join(t[1], t[2]);
  }
  std::vector<std::size_t> size(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles) ++size[parts.find(t[0])];
  const auto largest = static_cast<std::uint32_t>(std::max_element(size.begin(), size.end()) - size.begin());
  Mesh out;
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), 0);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (parts.find(v) != largest) continue;
    new_index[v] = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.push_back(mesh.vertices[v]);
  }
  for (const auto& t : mesh.triangles) {
    if (parts.find(t[0]) == largest) out.triangles.push_back({new_index[t[0]], new_index[t[1]], new_index[t[2]]});
  }
  compute_normals(out);
  return out;
}

Mesh remove_unobserved(const Mesh& mesh, const std::vector<bool>& seen, double foot_z_m) {
  constexpr double kMin_m2 = 1e-4;
  Parts parts(mesh.vertices.size());
  std::vector<double> area(mesh.vertices.size(), 0.0);
  const auto is_guess = [&](const std::array<std::uint32_t, 3>& t) {
    const auto is_low = [&](std::uint32_t v) { return mesh.vertices[v].z() <= foot_z_m; };
    return std::none_of(t.begin(), t.end(), [&](std::uint32_t v) { return seen[v]; }) &&
           !std::all_of(t.begin(), t.end(), is_low);
  };
  for (const auto& t : mesh.triangles) {
    if (!is_guess(t)) continue;
    parts.join(t[0], t[1]);
    parts.join(t[1], t[2]);
  }
  for (const auto& t : mesh.triangles) {
    if (!is_guess(t)) continue;
    const Eigen::Vector3f& a = mesh.vertices[t[0]];
    area[parts.find(t[0])] += 0.5 * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm();
  }
  return extract_submesh(
      mesh, [&](const std::array<std::uint32_t, 3>& t) { return !is_guess(t) || area[parts.find(t[0])] <= kMin_m2; });
}

}  // namespace houghstream::fusion
