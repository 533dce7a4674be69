#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <utility>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::world {

/// Returns whether every edge, with vertices at equal positions merged, is used once in each direction.
inline bool is_closed(const Mesh& mesh) {
  std::map<std::array<int, 3>, int> places;
  const auto place = [&](std::uint32_t index) {
    const Eigen::Vector3i key = (mesh.vertices[index] * 1e6F).array().round().cast<int>();
    return places.emplace(std::array<int, 3>{key.x(), key.y(), key.z()}, static_cast<int>(places.size())).first->second;
  };
  std::map<std::pair<int, int>, int> passes;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++passes[{place(triangle[i]), place(triangle[(i + 1) % 3])}];
  }
  for (const auto& [edge, count] : passes) {
    const auto back = passes.find({edge.second, edge.first});
    if (back == passes.end() || back->second != count) return false;
  }
  return true;
}

/// Positive where triangles are counter-clockwise seen from outside, cubic metres.
inline double signed_volume(const Mesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += static_cast<double>(mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]))) / 6.0;
  return volume;
}

/// Returns the fraction of triangles whose own normal agrees with that of their vertices.
inline double agreeing_normals(const Mesh& mesh) {
  int agreeing = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3f normal =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).normalized();
    if (normal.dot(mesh.normals[a] + mesh.normals[b] + mesh.normals[c]) > 0.0F) ++agreeing;
  }
  return static_cast<double>(agreeing) / static_cast<double>(mesh.triangles.size());
}

}  // namespace houghstream::world
