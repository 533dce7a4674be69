#include <Eigen/Geometry>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {

void compute_normals(Mesh& mesh) {
  mesh.normals.assign(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[triangle[0]];
    // The normal has twice the triangle's area as its length, so that the sum weights by area.
    const Eigen::Vector3f normal = (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
    for (const std::uint32_t index : triangle) mesh.normals[index] += normal;
  }
  for (Eigen::Vector3f& normal : mesh.normals) {
    const float length = normal.norm();
    normal = length > 0.0F ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::Zero();
  }
}

}  // namespace houghstream
