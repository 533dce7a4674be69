#include "tools/studies/recorded/scan_model.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "pipeline/base/checks.hpp"
#include "pipeline/geometry/mesh_part.hpp"
#include "pose/fusion/surface_nets.hpp"
#include "pose/model/mesh_bvh.hpp"

namespace houghstream {
namespace {

Mesh moved(Mesh mesh, const Eigen::Isometry3d& T) {
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = (T * vertex.cast<double>()).cast<float>();
  for (Eigen::Vector3f& normal : mesh.normals) normal = (T.linear() * normal.cast<double>()).cast<float>();
  return mesh;
}

cv::Vec3b colour_at(const Mesh& mesh, const ClosestPoint& hit) {
  cv::Vec3f sum(0.0F, 0.0F, 0.0F);
  for (std::size_t k = 0; k < 3; ++k) {
    sum += hit.weights[k] * cv::Vec3f(mesh.colours[mesh.triangles[hit.triangle][k]]);
  }
  return {cv::saturate_cast<std::uint8_t>(sum[0]), cv::saturate_cast<std::uint8_t>(sum[1]),
          cv::saturate_cast<std::uint8_t>(sum[2])};
}

void take_colours(const Mesh& from, Mesh& to) {
  if (from.colours.empty()) return;
  const MeshBvh tree(from);
  for (const Eigen::Vector3f& vertex : to.vertices) to.colours.push_back(colour_at(from, tree.nearest(vertex)));
}

}  // namespace

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
  constexpr std::size_t kStrayFraction = 500;  // one vertex in so many may be a stray
  std::vector<float> heights;
  heights.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) heights.push_back(vertex.z());
  const auto base = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / kStrayFraction);
  std::nth_element(heights.begin(), base, heights.end());
  return *base;
}

ScanModel fit_scan(const Mesh& scan, const Mesh& fused, double base_m) {
  const MeshAlignment with_disc = align_meshes(scan, fused);
  Mesh standing = moved(welded(scan), with_disc.T_target_source);
  const auto ground = static_cast<float>(base_height(standing) + base_m);
  standing = fusion::largest_part(crop_below(standing, Eigen::Hyperplane<float, 3>(Eigen::Vector3f::UnitZ(), -ground)));
  require(!standing.triangles.empty(), "scan: nothing is left {:.0f} mm above its base", 1e3 * base_m);
  ScanModel model;
  model.alignment = align_meshes(standing, fused);
  model.mesh = moved(std::move(standing), model.alignment.T_target_source);
  model.alignment.T_target_source = model.alignment.T_target_source * with_disc.T_target_source;
  take_colours(fused, model.mesh);
  return model;
}

}  // namespace houghstream
