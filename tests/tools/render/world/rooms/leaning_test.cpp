#include "tools/render/world/rooms/leaning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/rooms/stable_poses.hpp"
#include "tools/render/world/rooms/tipping.hpp"

namespace houghstream::world {
namespace {

constexpr int kSeeds = 6;

/// Returns a block and a leaning object.
AssetGroup leaning(int id, std::uint64_t seed) {
  Random random(seed);
  return put_leaning(make_taught_object(id).thing, id, random);
}

/// Returns the angle between the lean and the nearest stable pose, degrees.
double min_lean_deg(const PlacedAsset& placed, const std::vector<StablePoseFamily>& families) {
  const Eigen::Vector3d up = placed.T_world_object.linear().row(2);
  double max_cosine = -1.0;
  for (const StablePoseFamily& family : families) {
    for (const StablePose& attitude : family) {
      max_cosine = std::max(max_cosine, up.dot(attitude.R_table_object.row(2)));
    }
  }
  return std::acos(std::min(1.0, max_cosine)) * 180.0 / M_PI;
}

TEST(Leaning, ThingsTouchTheTableAndTheirBlockAndReachIntoNeither) {
  for (int id = 1; id <= kClassCount; ++id) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const AssetGroup group = leaning(id, seed);
      ASSERT_EQ(group.size(), 2U);
      EXPECT_EQ(group[0].thing->name, "block");
      EXPECT_EQ(group[0].object_id, 0);
      EXPECT_EQ(group[1].object_id, id);
      const Eigen::AlignedBox3d block = mesh_bounds(group[0].thing->mesh).cast<double>();
      const Eigen::Isometry3d T_block_object = group[0].T_world_object.inverse() * group[1].T_world_object;
      EXPECT_NEAR(block.min().z() + group[0].T_world_object.translation().z(), 0.0, 1e-6);
      double lowest = 1.0;
      double gap = 1.0;
      for (const auto& triangle : group[1].thing->mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
          constexpr int kSteps = 50;
          for (int step = 0; step < kSteps; ++step) {  // along the mesh's edges
            const Eigen::Vector3d a = group[1].thing->mesh.vertices[triangle[i]].cast<double>();
            const Eigen::Vector3d b = group[1].thing->mesh.vertices[triangle[(i + 1) % 3]].cast<double>();
            const Eigen::Vector3d point = a + (b - a) * (static_cast<double>(step) / kSteps);
            lowest = std::min(lowest, (group[1].T_world_object * point).z());
            gap = std::min(gap, block.exteriorDistance((T_block_object * point).eval()));
            EXPECT_FALSE(block.contains((T_block_object * point).eval())) << id << " " << seed;
          }
        }
      }
      EXPECT_NEAR(lowest, 0.0, 1e-6);
      EXPECT_LT(gap, 0.004) << id << " " << seed;
    }
  }
}

TEST(Leaning, TheCentreOfMassIsBetweenTableAndBlock) {
  for (int id = 1; id <= kClassCount; ++id) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const AssetGroup group = leaning(id, seed);
      const double near_side =
          group[0].T_world_object.translation().x() + static_cast<double>(mesh_bounds(group[0].thing->mesh).min().x());
      const double centre = (group[1].T_world_object * TippingBody(group[1].thing->mesh).centre_of_mass()).x();
      EXPECT_LT(centre, near_side) << id << " " << seed;
    }
  }
}

TEST(Leaning, NothingLeansAsItWouldRestAndSlantsDiffer) {
  for (int id = 1; id <= kClassCount; ++id) {
    const auto families = find_stable_poses(make_taught_object(id).thing->mesh);
    double minimum = 90.0;
    double maximum = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const double lean = min_lean_deg(leaning(id, seed)[1], families);
      EXPECT_LE(lean, kMaxLeanDeg + 1e-6);
      EXPECT_GT(lean, 2.0);
      minimum = std::min(minimum, lean);
      maximum = std::max(maximum, lean);
    }
    EXPECT_GT(maximum - minimum, 10.0) << id;
  }
}

TEST(Leaning, GroupsAreAboutTheirOrigin) {
  const AssetGroup group = leaning(2, 3);
  Eigen::AlignedBox2d extent;
  for (const PlacedAsset& placed : group) {
    for (const Eigen::Vector3f& vertex : placed.thing->mesh.vertices) {
      extent.extend((placed.T_world_object * vertex.cast<double>()).head<2>().eval());
    }
  }
  EXPECT_LT(extent.center().norm(), 1e-9);
}

}  // namespace
}  // namespace houghstream::world
