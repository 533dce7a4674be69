#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {

/// The triangles for which `is_kept` holds, and the vertices that they use, in the order in which they use them, with
/// their normals, colours and texture coordinates.
template <typename IsKept>
Mesh extract_submesh(const Mesh& mesh, const IsKept& is_kept) {
  constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();
  Mesh part;
  part.texture = mesh.texture;
  std::vector<std::uint32_t> new_index(mesh.vertices.size(), kDropped);
  std::vector<std::uint32_t> kept;
  for (std::array<std::uint32_t, 3> triangle : mesh.triangles) {
    if (!is_kept(triangle)) continue;
    for (std::uint32_t& vertex : triangle) {
      if (new_index[vertex] == kDropped) {
        new_index[vertex] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(vertex);
      }
      vertex = new_index[vertex];
    }
    part.triangles.push_back(triangle);
  }
  const auto take = [&kept](const auto& from, auto& to) {
    if (from.empty()) return;
    to.reserve(kept.size());
    for (const std::uint32_t vertex : kept) to.push_back(from[vertex]);
  };
  take(mesh.vertices, part.vertices);
  take(mesh.normals, part.normals);
  take(mesh.colours, part.colours);
  take(mesh.uvs, part.uvs);
  return part;
}

}  // namespace houghstream
