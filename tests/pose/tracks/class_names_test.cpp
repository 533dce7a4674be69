#include "pose/tracks/class_names.hpp"

#include <gtest/gtest.h>

#include "tests/pose/tracks/tracked_scene.hpp"

// Objects of a world when the object store changes.

namespace houghstream::tracks {
namespace {

using test::block;
using test::block_on_foot;
using test::distance;
using test::on_table;
using test::TrackedScene;

using Names = std::map<std::string, std::string>;

/// Returns models of a store by their numbers there.
TrackModels stored(const std::map<int, std::string>& names) {
  std::map<std::string, Mesh> meshes;
  for (const auto& [id, name] : names) meshes[name] = id == 1 ? block() : block_on_foot();
  TrackModels models = make_track_models(meshes, {});
  for (const auto& [id, name] : names) models.at(name).object_id = id;
  return models;
}

/// A scene with a can and a mug that have been seen for two seconds, as objects 1 and 2.
struct KnownScene : TrackedScene {
  KnownScene() {
    tracker.set_models(stored({{1, "can"}, {2, "mug"}}));
    show({{"can", on_table(-0.2, 0)}, {"mug", on_table(0.25, 0.1)}});
    frames(60);
  }
};

TEST(ClassNames, AnObjectIsRenamedWhereNumberAndMeshAreTheSame) {
  const TrackModels before = stored({{1, "can"}, {2, "mug"}});
  EXPECT_EQ(find_model_change(before, stored({{1, "tin"}, {2, "mug"}})).renamed, (Names{{"can", "tin"}}));
  EXPECT_TRUE(find_model_change(before, stored({{1, "tin"}, {2, "mug"}})).removed.empty());
  EXPECT_EQ(find_model_change(before, stored({{1, "mug"}, {2, "can"}})).renamed,
            (Names{{"can", "mug"}, {"mug", "can"}}));
  EXPECT_EQ(find_model_change(before, stored({{2, "mug"}})).removed, std::set<std::string>{"can"});
  EXPECT_TRUE(find_model_change(before, stored({{2, "mug"}, {3, "can"}})).removed.empty()) << "taught again";
  TrackModels other_mesh = stored({{1, "tin"}, {2, "mug"}});
  other_mesh.at("tin").mesh = block_on_foot();
  EXPECT_EQ(find_model_change(before, other_mesh).removed, std::set<std::string>{"can"});
  EXPECT_TRUE(find_model_change(before, other_mesh).renamed.empty());
  TrackModels no_store = make_track_models({{"can", block()}}, {});
  EXPECT_TRUE(find_model_change(no_store, make_track_models({{"tin", block()}}, {})).renamed.empty());
  EXPECT_TRUE(find_model_change({}, before).removed.empty());
}

TEST(ClassNames, WhatLeavesTheStoreIsGoneInTheNextFrame) {
  KnownScene scene;
  scene.tracker.set_models(stored({{2, "mug"}}));
  WorldObjects world = scene.frame();  // detector and poses have not taken over the store yet
  ASSERT_EQ(world.objects.size(), 2U);
  EXPECT_EQ(world.objects[0].class_name, "can");
  EXPECT_EQ(world.objects[0].state, TrackState::kGone);
  EXPECT_LT(world.objects[0].probability, 0.5F);
  EXPECT_NE(world.objects[0].reason.find("store"), std::string::npos) << world.objects[0].reason;
  EXPECT_EQ(world.objects[1].state, TrackState::kVisible);
  for (int i = 0; i < 90; ++i) {
    world = scene.frame();
    for (const TrackedObject& object : world.objects)
      EXPECT_TRUE(object.class_name == "mug" || object.state == TrackState::kGone) << i;
  }
  EXPECT_EQ(world.objects.size(), 1U) << "it is reported for two seconds";
  scene.tracker.set_models(stored({{1, "can"}, {2, "mug"}}));
  world = scene.frames(15);
  ASSERT_EQ(world.objects.size(), 2U) << "when it is taught again";
  EXPECT_EQ(world.objects[0].class_name, "can");
  EXPECT_EQ(world.objects[0].state, TrackState::kVisible);
}

void expect_renamed(const WorldObjects& world, const std::string& name, int frame) {
  ASSERT_EQ(world.objects.size(), 2U) << frame;
  EXPECT_EQ(world.objects[0].track_id, 1) << frame;
  EXPECT_EQ(world.objects[0].class_name, name) << frame;
  EXPECT_EQ(world.objects[0].state, TrackState::kVisible) << frame;
  EXPECT_LT(distance(world.objects[0], on_table(-0.2, 0)), 0.001) << frame;
  EXPECT_EQ(world.objects[1].track_id, 2) << frame;
}

TEST(ClassNames, WhatIsRenamedKeepsNumberAndPoseWhoeverTakesOverFirst) {
  KnownScene scene;
  scene.class_ids["tin"] = 1;
  for (int i = 0; i < 60; ++i) {  // the poses have the new name before the tracker does
    scene.show({{"tin", on_table(-0.2, 0)}, {"mug", on_table(0.25, 0.1)}});
    expect_renamed(scene.frame(), "can", i);
  }
  scene.tracker.set_models(stored({{1, "tin"}, {2, "mug"}}));
  for (int i = 0; i < 30; ++i) expect_renamed(scene.frame(), "tin", i);
  scene.tracker.set_models(stored({{1, "bowl"}, {2, "mug"}}));
  for (int i = 0; i < 60; ++i) expect_renamed(scene.frame(), "bowl", i);  // and after it
  scene.show({{"bowl", on_table(-0.2, 0)}, {"mug", on_table(0.25, 0.1)}});
  for (int i = 0; i < 30; ++i) expect_renamed(scene.frame(), "bowl", i);
  scene.show({{"can", on_table(-0.2, 0)}, {"mug", on_table(0.25, 0.1)}});
  for (int i = 0; i < 30; ++i) expect_renamed(scene.frame(), "bowl", i);  // from a sender who is two names behind
}

TEST(ClassNames, TwoObjectsMayChangeTheirNames) {
  KnownScene scene;
  scene.tracker.set_models(stored({{1, "mug"}, {2, "can"}}));
  const WorldObjects world = scene.look_if_any().value_or(WorldObjects{});
  ASSERT_EQ(world.objects.size(), 2U);
  EXPECT_EQ(world.objects[0].class_name, "mug");
  EXPECT_EQ(world.objects[1].class_name, "can");
}

TEST(ClassNames, AFormerNameThatIsTaughtAgainIsAnotherObject) {
  KnownScene scene;
  scene.class_ids["tin"] = 1;
  scene.class_ids["can"] = 3;
  scene.tracker.set_models(stored({{1, "tin"}, {2, "mug"}}));
  scene.tracker.set_models(stored({{1, "tin"}, {2, "mug"}, {3, "can"}}));
  scene.show({{"tin", on_table(-0.2, 0)}, {"mug", on_table(0.25, 0.1)}, {"can", on_table(0, 0.2)}});
  const WorldObjects world = scene.frames(15);
  ASSERT_EQ(world.objects.size(), 3U);
  EXPECT_EQ(world.objects[0].class_name, "tin");
  EXPECT_EQ(world.objects[2].class_name, "can");
  EXPECT_EQ(world.objects[2].track_id, 3);
}

TEST(ClassNames, WhatAnotherStoreKnowsIsAnObjectOfItsOwn) {
  KnownScene scene;
  scene.class_ids["plate"] = 1;  // the id that the can has in this store
  scene.posed.emplace_back("plate", on_table(0, 0.2));
  scene.standing.emplace_back("plate", on_table(0, 0.2));
  EXPECT_EQ(scene.frames(15).objects.size(), 3U);
}

}  // namespace
}  // namespace houghstream::tracks
