#pragma once

#include <cmath>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::teach {

/// A closed box with a block of half its size on top, off its middle along x and y: no mirror image of it is like it.
/// Two colours. Metres.
inline void append_box(const Eigen::Vector3f& low, const Eigen::Vector3f& high, const cv::Vec3b& colour, Mesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                               (i & 4) != 0 ? high.z() : low.z());
    mesh.colours.push_back(colour);
  }
  constexpr std::array<std::array<std::uint32_t, 3>, 12> kFaces = {{{0, 2, 3},
                                                                    {0, 3, 1},
                                                                    {4, 5, 7},
                                                                    {4, 7, 6},
                                                                    {0, 1, 5},
                                                                    {0, 5, 4},
                                                                    {2, 6, 7},
                                                                    {2, 7, 3},
                                                                    {0, 4, 6},
                                                                    {0, 6, 2},
                                                                    {1, 3, 7},
                                                                    {1, 7, 5}}};
  for (const auto& face : kFaces) mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
}

inline Mesh crooked_part(float size_m = 0.1F) {
  Mesh mesh;
  append_box(size_m * Eigen::Vector3f(-0.5F, -0.3F, 0.0F), size_m * Eigen::Vector3f(0.5F, 0.3F, 0.4F), {40, 40, 200},
             mesh);
  append_box(size_m * Eigen::Vector3f(-0.5F, -0.3F, 0.4F), size_m * Eigen::Vector3f(-0.1F, 0.0F, 1.0F), {200, 160, 30},
             mesh);
  compute_normals(mesh);
  return mesh;
}

/// Its mirror image, faces outwards.
inline Mesh mirrored(Mesh mesh) {
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex.x() = -vertex.x();
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  compute_normals(mesh);
  return mesh;
}

/// Moved and turned.
inline Mesh moved(Mesh mesh) {
  const Eigen::Isometry3f motion(Eigen::Translation3f(0.02F, -0.1F, 0.3F) *
                                 Eigen::AngleAxisf(0.7F, Eigen::Vector3f(1, 2, -1).normalized()));
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = motion * vertex;
  compute_normals(mesh);
  return mesh;
}

}  // namespace houghstream::teach
