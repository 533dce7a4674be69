#include "pose/fusion/surface_smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pipeline/base/random.hpp"
#include "pose/fusion/surface_nets.hpp"

namespace houghstream::fusion {
namespace {

constexpr double kHalf_m = 0.03;
constexpr double kVoxel_m = 0.002;

/// Signed distances of a box with `noise_m` in them, as fusion leaves them.
Mesh box_surface(double noise_m) {
  TsdfVolume grid;
  grid.voxel = kVoxel_m;
  grid.nx = grid.ny = grid.nz = 40;
  grid.origin = Eigen::Vector3d::Constant(-19.6 * kVoxel_m);
  grid.distance.resize(64000);
  grid.weight.assign(64000, 1.0F);
  Random random(3);
  for (int k = 0; k < 40; ++k) {
    for (int j = 0; j < 40; ++j) {
      for (int i = 0; i < 40; ++i) {
        const double distance = grid.centre(i, j, k).cwiseAbs().maxCoeff() - kHalf_m + noise_m * random.normal();
        grid.distance[grid.index(i, j, k)] = static_cast<float>(std::clamp(distance / (4.0 * kVoxel_m), -1.0, 1.0));
      }
    }
  }
  return largest_part(extract_surface(grid));
}

/// Errors of the vertices on the box's top, away from its edges: distance, and angle of the normals.
struct Roughness {
  double off_m = 0.0, rotated = 0.0;
};

Roughness roughness(const Mesh& mesh) {
  Roughness sum;
  int count = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d p = mesh.vertices[i].cast<double>();
    if (p.z() < 0.5 * kHalf_m || p.head<2>().cwiseAbs().maxCoeff() > 0.7 * kHalf_m) continue;
    sum.off_m += std::abs(p.z() - kHalf_m);
    sum.rotated += std::acos(std::min(1.0, static_cast<double>(mesh.normals[i].z())));
    ++count;
  }
  return {sum.off_m / count, sum.rotated / count};
}

TEST(SurfaceSmoothing, NoiseGoes) {
  Mesh mesh = box_surface(0.0004);
  const Roughness before = roughness(mesh);
  smooth_surface(2, mesh);
  const Roughness after = roughness(mesh);
  EXPECT_LT(after.rotated, 0.3 * before.rotated);
  EXPECT_LT(after.off_m, 0.7 * before.off_m);
}

TEST(SurfaceSmoothing, EdgesStay) {
  Mesh mesh = box_surface(0.0);
  const Eigen::AlignedBox3f before = mesh_bounds(mesh);
  smooth_surface(1, mesh);
  const Eigen::AlignedBox3f after = mesh_bounds(mesh);
  EXPECT_LT((before.sizes() - after.sizes()).cwiseAbs().maxCoeff(), 0.5F * kVoxel_m);
  int edges = 0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) edges += vertex.cwiseAbs().minCoeff() > 0.9F * kHalf_m ? 1 : 0;
  EXPECT_GT(edges, 0) << "its corners are rounded away";
}

TEST(SurfaceSmoothing, ThreadsMakeNoDifference) {
  Mesh one = box_surface(0.0004), many = one;
  smooth_surface(1, one);
  smooth_surface(4, many);
  EXPECT_EQ(one.vertices, many.vertices);
  EXPECT_EQ(one.normals, many.normals);
}

}  // namespace
}  // namespace houghstream::fusion
