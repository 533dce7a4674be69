#include "pose/model/mesh_bvh.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

/// Returns a bumpy sheet of 2 x 20 x 20 triangles over the square from 0 to 1 m.
Mesh flat_sheet() {
  constexpr std::uint32_t kCells = 20;
  Mesh mesh;
  Random random(3);
  for (std::uint32_t y = 0; y <= kCells; ++y) {
    for (std::uint32_t x = 0; x <= kCells; ++x) {
      mesh.vertices.emplace_back(static_cast<float>(x) / kCells, static_cast<float>(y) / kCells,
                                 static_cast<float>(0.05 * random.uniform()));
    }
  }
  for (std::uint32_t y = 0; y < kCells; ++y) {
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t i = y * (kCells + 1) + x;
      mesh.triangles.push_back({i, i + 1, i + kCells + 1});
      mesh.triangles.push_back({i + 1, i + kCells + 2, i + kCells + 1});
    }
  }
  return mesh;
}

TEST(MeshBvh, DistancesToOneTriangleAreThoseOfItsFaceEdgesAndCorners) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const MeshBvh tree(mesh);
  EXPECT_NEAR(tree.nearest({0.25F, 0.25F, -0.5F}).distance, 0.5F, 1e-6F) << "over the face";
  EXPECT_NEAR(tree.nearest({0.5F, -0.3F, 0.4F}).distance, 0.5F, 1e-6F) << "beside an edge";
  EXPECT_NEAR(tree.nearest({1.0F, 1.0F, 0.0F}).distance, std::sqrt(0.5F), 1e-6F) << "beside the long edge";
  EXPECT_NEAR(tree.nearest({-3.0F, -4.0F, 0.0F}).distance, 5.0F, 1e-6F) << "beyond a corner";
  const ClosestPoint hit = tree.nearest({0.2F, 0.5F, 0.1F});
  EXPECT_NEAR(hit.weights[0], 0.3F, 1e-6F);
  EXPECT_NEAR(hit.weights[1], 0.2F, 1e-6F);
  EXPECT_NEAR(hit.weights[2], 0.5F, 1e-6F);
}

TEST(MeshBvh, FindsWhatATryOfAllTrianglesFinds) {
  const Mesh mesh = flat_sheet();
  const MeshBvh tree(mesh);
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3f point(static_cast<float>(random.uniform(-0.2, 1.2)),
                                static_cast<float>(random.uniform(-0.2, 1.2)),
                                static_cast<float>(random.uniform(-0.3, 0.3)));
    float nearest = 1e9F;
    for (const auto& triangle : mesh.triangles) {
      Mesh alone = mesh;
      alone.triangles = {triangle};
      nearest = std::min(nearest, MeshBvh(alone).nearest(point).distance);
    }
    EXPECT_NEAR(tree.nearest(point).distance, nearest, 1e-6F);
  }
}

TEST(MeshBvh, AGuessChangesNothing) {
  const Mesh mesh = flat_sheet();
  const MeshBvh tree(mesh);
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f point(static_cast<float>(random.uniform(-0.2, 1.2)),
                                static_cast<float>(random.uniform(-0.2, 1.2)),
                                static_cast<float>(random.uniform(-0.3, 0.3)));
    const ClosestPoint nearest = tree.nearest(point);
    for (const std::uint32_t guess : {nearest.triangle, static_cast<std::uint32_t>(random.below(800))}) {
      const ClosestPoint found = tree.nearest_with_guess(point, guess);
      EXPECT_EQ(found.triangle, nearest.triangle);
      EXPECT_EQ(found.distance, nearest.distance);
      EXPECT_EQ(found.weights, nearest.weights);
    }
  }
}

TEST(MeshBvh, RefusesAMeshWithoutTriangles) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}};
  EXPECT_THROW(MeshBvh tree(mesh), InputError);
}

}  // namespace
}  // namespace houghstream
