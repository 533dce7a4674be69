#include <gtest/gtest.h>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream {
namespace {

TEST(MeshNormals, LargerTrianglesWeighMore) {
  Mesh mesh;
  // Two triangles share the edge from 0 to 1: one of area 2 facing +z, one of area 1 facing +x (seen from outside).
  mesh.vertices = {{0, 0, 0}, {0, 2, 0}, {-2, 0, 0}, {0, 0, -1}, {9, 9, 9}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}};
  compute_normals(mesh);
  ASSERT_EQ(mesh.normals.size(), 5U);
  const Eigen::Vector3f shared = Eigen::Vector3f(1, 0, 2).normalized();
  EXPECT_LT((mesh.normals[0] - shared).norm(), 1e-6F);
  EXPECT_LT((mesh.normals[2] - Eigen::Vector3f::UnitZ()).norm(), 1e-6F);
  EXPECT_LT((mesh.normals[3] - Eigen::Vector3f::UnitX()).norm(), 1e-6F);
  EXPECT_EQ(mesh.normals[4].norm(), 0.0F);  // belongs to no triangle
}

}  // namespace
}  // namespace houghstream
