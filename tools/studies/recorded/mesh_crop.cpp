#include "tools/studies/recorded/mesh_crop.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/mesh_part.hpp"

namespace houghstream {

Mesh crop_below(const Mesh& mesh, const Eigen::Hyperplane<float, 3>& plane) {
  const auto is_above = [&](std::uint32_t vertex) { return plane.signedDistance(mesh.vertices[vertex]) >= 0.0F; };
  return extract_submesh(mesh, [&](const std::array<std::uint32_t, 3>& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), is_above);
  });
}

Mesh welded(const Mesh& mesh) {
  Mesh out;
  std::map<std::array<float, 3>, std::uint32_t> index_at;
  std::vector<std::uint32_t> new_index;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const auto next = static_cast<std::uint32_t>(out.vertices.size());
    const auto [place, is_new] = index_at.try_emplace({vertex.x(), vertex.y(), vertex.z()}, next);
    if (is_new) out.vertices.push_back(vertex);
    new_index.push_back(place->second);
  }
  for (const auto& [a, b, c] : mesh.triangles) out.triangles.push_back({new_index[a], new_index[b], new_index[c]});
  compute_normals(out);
  return out;
}

double base_height(const Mesh& mesh) {
  require(!mesh.vertices.empty(), "mesh without vertices, expected one to stand on a base");
  constexpr std::size_t kStrayShare = 500;  // one vertex in so many
  std::vector<float> heights;
  heights.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) heights.push_back(vertex.z());
  const auto base = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / kStrayShare);
  std::nth_element(heights.begin(), base, heights.end());
  return *base;
}

}  // namespace houghstream
