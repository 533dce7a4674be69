#include "pose/fusion/surface_nets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace houghstream::fusion {
namespace {

const Eigen::Vector3d kLarge(0.0, 0.0, 0.0);
const Eigen::Vector3d kSmall(0.06, 0.0, 0.0);

/// Spheres of 3 cm and 8 mm radius in voxels of 2 mm.
TsdfVolume two_spheres() {
  TsdfVolume grid;
  grid.nx = 64;
  grid.ny = 40;
  grid.nz = 40;
  grid.voxel = 0.002;
  grid.origin = Eigen::Vector3d(-0.04, -0.04, -0.04);
  for (int k = 0; k < grid.nz; ++k) {
    for (int j = 0; j < grid.ny; ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        const Eigen::Vector3d p = grid.centre(i, j, k);
        const double distance = std::min((p - kLarge).norm() - 0.03, (p - kSmall).norm() - 0.008);
        grid.distance.push_back(static_cast<float>(std::clamp(distance / 0.006, -1.0, 1.0)));
      }
    }
  }
  return grid;
}

/// Directed edges that have no opposite one: none on a closed, consistently turned surface.
int open_edges(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{t[k], t[(k + 1) % 3]}];
      --edges[{t[(k + 1) % 3], t[k]}];
    }
  }
  return static_cast<int>(std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second != 0; }));
}

TEST(GridSurface, SpheresComeBackClosedAndTurnedOutwards) {
  const Mesh mesh = extract_surface(two_spheres());
  ASSERT_FALSE(mesh.triangles.empty());
  EXPECT_EQ(open_edges(mesh), 0);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d v = mesh.vertices[i].cast<double>();
    const bool on_small = (v - kSmall).norm() < 0.015;
    const Eigen::Vector3d out = v - (on_small ? kSmall : kLarge);
    EXPECT_NEAR(out.norm(), on_small ? 0.008 : 0.03, 0.0004);
    EXPECT_GT(mesh.normals[i].cast<double>().dot(out.normalized()), 0.9);
  }
}

TEST(GridSurface, TheLargestPartIsKept) {
  const Mesh part = largest_part(extract_surface(two_spheres()));
  EXPECT_EQ(open_edges(part), 0);
  ASSERT_EQ(part.normals.size(), part.vertices.size());
  for (const Eigen::Vector3f& v : part.vertices) EXPECT_NEAR(v.norm(), 0.03F, 0.0004F);
}

TEST(GridSurface, WhatReachesTheBorderIsClosedThere) {
  TsdfVolume grid = two_spheres();
  std::fill(grid.distance.begin(), grid.distance.end(), -1.0F);
  const Mesh mesh = extract_surface(grid);
  EXPECT_EQ(open_edges(mesh), 0);
  EXPECT_FALSE(mesh.triangles.empty());
}

TEST(GridSurface, NothingInsideIsNoSurface) {
  TsdfVolume grid = two_spheres();
  std::fill(grid.distance.begin(), grid.distance.end(), 1.0F);
  EXPECT_TRUE(extract_surface(grid).triangles.empty());
  EXPECT_TRUE(largest_part(extract_surface(grid)).triangles.empty());
}

TEST(GridSurface, WhatNobodySawIsTakenOutUnlessItIsSmallOrBelowTheFoot) {
  const Mesh closed = largest_part(extract_surface(two_spheres()));
  const auto left_of = [&](double unseen_above, double foot) {
    Mesh mesh = closed;
    mesh.colours.assign(mesh.vertices.size(), cv::Vec3b(1, 2, 3));
    std::vector<bool> seen;
    for (const Eigen::Vector3f& vertex : mesh.vertices) seen.push_back(vertex.z() <= unseen_above);
    mesh = remove_unobserved(mesh, seen, foot);
    EXPECT_EQ(mesh.colours.size(), mesh.vertices.size());
    EXPECT_EQ(mesh.normals.size(), mesh.vertices.size());
    for (const auto& t : mesh.triangles) EXPECT_LT(*std::max_element(t.begin(), t.end()), mesh.vertices.size());
    return mesh;
  };
  const Mesh open = left_of(0.015, -1.0);
  EXPECT_GT(open_edges(open), 0);
  EXPECT_LT(mesh_bounds(open).max().z(), 0.02F);
  EXPECT_LT(mesh_bounds(open).min().z(), -0.029F);
  EXPECT_EQ(left_of(0.0298, -1.0).triangles.size(), closed.triangles.size()) << "a few square millimetres";
  EXPECT_EQ(left_of(0.015, 1.0).triangles.size(), closed.triangles.size()) << "all of it is below the foot";
}

}  // namespace
}  // namespace houghstream::fusion
