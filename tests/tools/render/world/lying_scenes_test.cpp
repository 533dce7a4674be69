#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/rooms/table_setter.hpp"
#include "tools/render/world/scenes.hpp"

namespace houghstream::world {
namespace {

std::vector<const char*> lying_scenes() {
  std::vector<const char*> names(kLyingScenes.begin(), kLyingScenes.end());
  names.insert(names.end(), kLyingDevelopmentScenes.begin(), kLyingDevelopmentScenes.end());
  return names;
}

const Scene& lying_scene(const std::string& name) {
  static std::map<std::string, Scene> scenes;
  const auto found = scenes.find(name);
  return found != scenes.end() ? found->second : scenes.emplace(name, make_named_scene(name)).first->second;
}

std::vector<Eigen::Vector3d> corners_world(const PlacedAsset& placed) {
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector3f& vertex : placed.thing->mesh.vertices)
    corners.push_back(placed.T_world_object * vertex.cast<double>());
  return corners;
}

// Returns the depth to which `corners` reach into the wedge's upper side, metres; the wedge's is its steepest normal
// upwards.
double depth_in_wedge(const PlacedAsset& wedge, const std::vector<Eigen::Vector3d>& corners) {
  const Mesh& mesh = wedge.thing->mesh;
  double deepest = -1.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d pa = wedge.T_world_object * mesh.vertices[a].cast<double>();
    const Eigen::Vector3d pb = wedge.T_world_object * mesh.vertices[b].cast<double>();
    const Eigen::Vector3d pc = wedge.T_world_object * mesh.vertices[c].cast<double>();
    const Eigen::Vector3d normal = (pb - pa).cross(pc - pa).normalized();
    if (normal.z() < 0.5) continue;
    for (const Eigen::Vector3d& corner : corners) deepest = std::max(deepest, normal.dot(pa - corner));
  }
  return deepest;
}

// Returns all movable assets on the table: those wholly above z = -1 mm and within arm's reach of the origin.
std::vector<const PlacedAsset*> on_table(const World& world) {
  std::vector<const PlacedAsset*> things;
  for (const PlacedAsset& placed : world.items) {
    const std::vector<Eigen::Vector3d> corners = corners_world(placed);
    const bool here = std::all_of(corners.begin(), corners.end(), [](const Eigen::Vector3d& corner) {
      return corner.z() > -1e-3 && corner.head<2>().norm() < 1.2;
    });
    if (here) things.push_back(&placed);
  }
  return things;
}

// Returns the rectangle round the whole asset, along its own rotation about the vertical.
Footprint footprint_of(const PlacedAsset& placed) {
  const Eigen::Matrix3d R = placed.T_world_object.rotation();
  const int column = R.col(0).head<2>().norm() > 0.5 ? 0 : 1;
  Footprint footprint;
  footprint.yaw_rad = std::atan2(R(1, column), R(0, column));
  const Eigen::Rotation2Dd back(-footprint.yaw_rad);
  Eigen::AlignedBox2d extent;
  for (const Eigen::Vector3d& corner : corners_world(placed)) extent.extend((back * corner.head<2>()).eval());
  footprint.half = 0.5 * extent.sizes();
  footprint.centre = Eigen::Rotation2Dd(footprint.yaw_rad) * extent.center();
  return footprint;
}

TEST(LyingScenes, NameEachClassTwiceAndNoneUpright) {
  for (const char* name : lying_scenes()) {
    SCOPED_TRACE(name);
    std::map<int, int> counts;
    for (const PlacedAsset& placed : lying_scene(name).world.items) {
      if (placed.object_id == 0) continue;
      ++counts[placed.object_id];
      EXPECT_LT(placed.T_world_object.linear()(2, 2), std::cos(11.9 * M_PI / 180.0));
    }
    EXPECT_EQ(counts, (std::map<int, int>{{1, 2}, {2, 2}, {3, 2}, {4, 2}}));
  }
}

TEST(LyingScenes, LyingObjectsTouchTheTableAndTiltedOnesTheirWedge) {
  for (const char* name : lying_scenes()) {
    SCOPED_TRACE(name);
    const std::vector<PlacedAsset>& items = lying_scene(name).world.items;
    for (std::size_t i = 1; i < items.size(); ++i) {
      if (items[i].object_id == 0) continue;
      const std::vector<Eigen::Vector3d> corners = corners_world(items[i]);
      double lowest = 1.0;
      for (const Eigen::Vector3d& corner : corners) lowest = std::min(lowest, corner.z());
      if (items[i - 1].thing->name == "wedge") {
        EXPECT_NEAR(depth_in_wedge(items[i - 1], corners), 0.0, 1e-5);
        EXPECT_GT(lowest, 0.0);
      } else {
        EXPECT_NEAR(lowest, 0.0, 1e-6);
      }
    }
  }
}

TEST(LyingScenes, ThingsDoNotTouchEachOther) {
  for (const char* name : lying_scenes()) {
    SCOPED_TRACE(name);
    const std::vector<const PlacedAsset*> things = on_table(lying_scene(name).world);
    EXPECT_GE(things.size(), 16U);
    for (std::size_t i = 0; i < things.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const bool on_it = things[j]->thing->name == "wedge" && j + 1 == i;
        if (on_it) continue;
        EXPECT_FALSE(footprints_touch(footprint_of(*things[i]), footprint_of(*things[j]), 0.0))
            << things[i]->thing->name << " and " << things[j]->thing->name;
      }
    }
  }
}

TEST(LyingScenes, SeedsAreOddForTestsAndEvenForDevelopment) {
  for (const char* name : kLyingScenes) EXPECT_EQ(lying_scene(name).seed % 2, 1U);
  for (const char* name : kLyingDevelopmentScenes) EXPECT_EQ(lying_scene(name).seed % 2, 0U);
}

}  // namespace
}  // namespace houghstream::world
