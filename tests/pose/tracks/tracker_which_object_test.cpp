#include <gtest/gtest.h>

#include "pose/tracks/tracker.hpp"
#include "tests/pose/tracks/tracked_scene.hpp"

namespace houghstream::tracks {
namespace {

using test::block;
using test::block_on_foot;
using test::distance;
using test::foot;
using test::half_turn;
using test::models_on_foot;
using test::on_table;
using test::TrackedScene;

TEST(TrackerWhichObject, APoseThatLooksTheSameIsOfTheSameObjectWhereverItsOriginIs) {
  TrackedScene scene;
  scene.tracker.set_models(models_on_foot());
  scene.standing = {{"can", on_table(0, 0)}};
  WorldObjects world;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Isometry3d upright = on_table(0, 0) * foot();
    scene.posed = {{"can", i < 30 ? upright : upright * half_turn()}};
    world = scene.frame();
    EXPECT_LE(world.objects.size(), 1U) << i;
  }
  ASSERT_EQ(world.objects.size(), 1U);
  EXPECT_LT(distance(world.objects[0], on_table(0, 0) * foot()), 0.001);
}

TEST(TrackerWhichObject, WhereAnObjectStandsNoneOfItsClassStandsOnItsHead) {
  TrackedScene scene;
  scene.tracker.set_models(make_track_models({{"can", block_on_foot()}}, {}));
  scene.standing = {{"can", on_table(0, 0)}};
  for (int i = 0; i < 60; ++i) {
    const Eigen::Isometry3d upright = on_table(0, 0) * foot();
    scene.posed = {{"can", upright}};
    if (i >= 10) scene.posed.emplace_back("can", upright * half_turn());
    EXPECT_LE(scene.frame().objects.size(), 1U) << i;
  }
}

TEST(TrackerWhichObject, WhereAnotherClassIsRecognisedAnObjectGoesWhereverTheirOriginsAre) {
  TrackedScene scene;
  scene.tracker.set_models(make_track_models({{"can", block()}, {"mug", block_on_foot()}}, {}));
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(60);
  scene.posed = {{"mug", on_table(0, 0) * foot()}};
  const WorldObjects world = scene.frames(30);
  ASSERT_EQ(world.objects.size(), 2U);
  EXPECT_EQ(world.objects[0].state, TrackState::kGone);
  EXPECT_NE(world.objects[0].reason.find("something else"), std::string::npos) << world.objects[0].reason;
  EXPECT_EQ(world.objects[1].class_name, "mug");
}

TEST(TrackerWhichObject, WhatHasTwoTurnsDoesNotSpinWhenItIsPushed) {
  TrackedScene scene;
  for (int i = 0; i < 90; ++i) {
    const double along = i < 60 ? -0.3 : -0.3 + 0.015 * (i - 59);
    scene.show({{"can", on_table(along, 0, i % 3 == 0 ? 2.0 : 0.0)}});
    const WorldObjects world = scene.frame();
    if (i < 30) continue;
    ASSERT_EQ(world.objects.size(), 1U) << i;
    EXPECT_LT(world.objects[0].velocity.tail<3>().norm(), 2.0) << i;
    EXPECT_LT(Eigen::AngleAxisd(world.objects[0].T_world_object.linear()).angle(), 0.05) << i;
  }
}

TEST(TrackerWhichObject, OnePoseElsewhereTellsWhereDepthHasDoubted) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(60);
  scene.standing = {{"can", on_table(0.05, 0)}};
  scene.posed.clear();
  scene.frames(2);
  scene.posed = scene.standing;
  const WorldObjects world = scene.frame();
  ASSERT_EQ(world.objects.size(), 1U);
  EXPECT_EQ(world.objects[0].track_id, 1);
  EXPECT_LT(distance(world.objects[0], on_table(0.05, 0)), 0.001);
}

TEST(TrackerWhichObject, TwoTurnsOfAnObjectAreNeverAveraged) {
  TrackedScene scene;
  for (int i = 0; i < 120; ++i) {
    scene.show({{"can", on_table(0, 0, i % 3 == 0 ? 2.0 : 0.0)}});
    const WorldObjects world = scene.frame();
    if (world.objects.empty()) continue;
    const Eigen::AngleAxisd rotation(world.objects[0].T_world_object.linear());
    EXPECT_TRUE(rotation.angle() < 0.01 || std::abs(rotation.angle() - 2.0) < 0.01) << i << ": " << rotation.angle();
    if (i > 30) {
      EXPECT_LT(rotation.angle(), 0.01) << i;
    }
  }
}

TEST(TrackerWhichObject, CamerasThatDisagreeByTwoCentimetresSeeOneObjectThatStands) {
  TrackedScene scene;
  WorldObjects world;
  for (int i = 0; i < 90; ++i) {
    scene.utime += test::kFrameUs;
    scene.channel = "LEFT";
    scene.show({{"can", on_table(0, 0)}});
    scene.look();
    scene.channel = "RIGHT";
    scene.posed = {{"can", on_table(0.02, 0)}};
    world = scene.look();
    ASSERT_LE(world.objects.size(), 1U);
    for (const TrackedObject& object : world.objects) EXPECT_FALSE(object.moving) << i;
  }
  ASSERT_EQ(world.objects.size(), 1U);
}

}  // namespace
}  // namespace houghstream::tracks
