#include "tools/render/world/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/mesh_parts.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/rooms/table_setter.hpp"

namespace houghstream::world {
namespace {

// Each is made once: drawing all textures takes a while.
const Scene& test_scene(const std::string& name) {
  static std::map<std::string, Scene> scenes;
  const auto found = scenes.find(name);
  return found != scenes.end() ? found->second : scenes.emplace(name, make_named_scene(name)).first->second;
}

double yaw_of(const Eigen::Isometry3d& T) {
  return std::atan2(T.linear()(1, 0), T.linear()(0, 0));
}

std::multiset<int> ids_in_ground_truth(const Scene& scene) {
  std::multiset<int> ids;
  for (const PlacedAsset& placed : scene.world.items) {
    if (placed.object_id != 0) ids.insert(placed.object_id);
  }
  return ids;
}

// Returns footprints of the assets that stand on the table: their lowest points are at the table's height.
std::vector<Footprint> standing(const World& world) {
  std::vector<Footprint> footprints;
  for (const PlacedAsset& placed : world.items) {
    const Eigen::AlignedBox3d bounds = mesh_bounds(placed.thing->mesh).cast<double>();
    if (std::abs(placed.T_world_object.translation().z() + bounds.min().z()) > 1e-6) continue;
    footprints.push_back(
        {placed.T_world_object.translation().head<2>(), 0.5 * bounds.sizes().head<2>(), yaw_of(placed.T_world_object)});
  }
  return footprints;
}

void expect_apart(const World& world, std::size_t min_count) {
  const std::vector<Footprint> footprints = standing(world);
  EXPECT_GE(footprints.size(), min_count);
  for (std::size_t i = 0; i < footprints.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(footprints_touch(footprints[i], footprints[j], 0.0));
  }
}

// Returns all scenes whose ground truth names an object.
std::vector<const char*> scenes_with_ground_truth() {
  std::vector<const char*> names(kTestScenes.begin(), kTestScenes.end());
  names.insert(names.end(), kTwentyClassScenes.begin(), kTwentyClassScenes.end());
  names.insert(names.end(), kTwentyClassDevelopmentScenes.begin(), kTwentyClassDevelopmentScenes.end());
  return names;
}

TEST(Scenes, TestAndTrainingSeedsNeverCoincide) {
  for (std::uint64_t number = 0; number < 2000; ++number) {
    const std::uint64_t training = world_seed(DatasetSplit::kTraining, number);
    const std::uint64_t test = world_seed(DatasetSplit::kTest, number);
    EXPECT_EQ(training % 2, 0U);
    EXPECT_EQ(test % 2, 1U);
    EXPECT_EQ(aspect_seed(training, number) % 2, 0U);
    EXPECT_EQ(aspect_seed(test, number) % 2, 1U);
  }
  for (const char* name : kTestScenes) EXPECT_EQ(test_scene(name).seed % 2, 1U);
  for (const char* name : kTwentyClassScenes) EXPECT_EQ(test_scene(name).seed % 2, 1U);
  for (const char* name : kTwentyClassDevelopmentScenes) EXPECT_EQ(test_scene(name).seed % 2, 0U);
  EXPECT_EQ(make_background_scene(0, 1).seed % 2, 0U);
}

TEST(Scenes, HoldTheFourClassesAmongClutterThatDoesNotTouch) {
  for (const char* name : kTestScenes) {
    SCOPED_TRACE(name);
    const Scene& scene = test_scene(name);
    EXPECT_EQ(ids_in_ground_truth(scene), (std::multiset<int>{1, 2, 3, 4}));
    expect_apart(scene.world, 12);
  }
}

TEST(Scenes, HoldOtherInstancesThatTheTruthDoesNotName) {
  for (const char* name : kTestScenes) {
    int others = 0;
    for (const PlacedAsset& placed : test_scene(name).world.items) {
      if (placed.thing->name.rfind("other_", 0) != 0) continue;
      ++others;
      EXPECT_EQ(placed.object_id, 0) << name;
    }
    EXPECT_GE(others, 3) << name;
  }
}

// The first and second scene, the third and fourth and so on hold all twenty.
template <std::size_t kCount>
void expect_twenty_in_turn(const std::array<const char*, kCount>& names) {
  const std::vector<int> twenty = twenty_class_ids();
  for (std::size_t i = 0; i < kCount; i += 2) {
    std::set<int> all;
    for (const char* name : {names[i], names[i + 1]}) {
      SCOPED_TRACE(name);
      const std::multiset<int> ids = ids_in_ground_truth(test_scene(name));
      EXPECT_EQ(ids.size(), 12U);
      for (const int id : {1, 2, 3, 4}) EXPECT_EQ(ids.count(id), 1U);
      all.insert(ids.begin(), ids.end());
      expect_apart(test_scene(name).world, 18);
    }
    EXPECT_EQ(all, std::set<int>(twenty.begin(), twenty.end()));
  }
}

TEST(Scenes, PairsOfScenesHoldTheTwentyClassesAmongClutter) {
  expect_twenty_in_turn(kTwentyClassScenes);
  expect_twenty_in_turn(kTwentyClassDevelopmentScenes);
}

TEST(Scenes, ObjectsAreBetween60CentimetresAnd250FromTheCamera) {
  for (const char* name : scenes_with_ground_truth()) {
    SCOPED_TRACE(name);
    const Scene& scene = test_scene(name);
    for (int i = 0; i <= 100; ++i) {
      const Eigen::Isometry3d T_camera_world = camera_at(scene.trajectory, i / 100.0);
      for (const PlacedAsset& placed : scene.world.items) {
        if (placed.object_id == 0) continue;
        const double z = (T_camera_world * placed.T_world_object).translation().z();
        EXPECT_GT(z, 0.55);
        EXPECT_LT(z, 2.5);
      }
    }
  }
}

TEST(Scenes, CameraMovesSmoothly) {
  const Trajectory trajectory = make_trajectory(1);
  for (int i = 0; i < 299; ++i) {
    const Eigen::Isometry3d step = camera_at(trajectory, (i + 1) / 299.0) * camera_at(trajectory, i / 299.0).inverse();
    EXPECT_LT(step.translation().norm(), 0.03);
    EXPECT_LT(Eigen::AngleAxisd(step.linear()).angle(), 0.02);
  }
}

TEST(Scenes, BackgroundsHoldNoTaughtObject) {
  std::set<std::string> taught;
  for (int id = 1; id <= kTaughtObjectCount; ++id) taught.insert(make_taught_object(id).name);
  for (const int id : twenty_class_ids()) taught.insert(make_taught_object(id).name);
  for (int i = 0; i < kRoomStyles; ++i) {
    for (const PlacedAsset& placed : make_background_scene(i, 1).world.items)
      EXPECT_EQ(taught.count(placed.thing->name), 0U);
  }
}

TEST(Scenes, UnknownNamesAreRefused) {
  EXPECT_THROW(make_named_scene("cellar_1"), InputError);
}

}  // namespace
}  // namespace houghstream::world
