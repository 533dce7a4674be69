#include <gtest/gtest.h>

#include "pose/tracks/tracker.hpp"
#include "tests/pose/tracks/tracked_scene.hpp"

// These tests check the number of an object after it was carried, pushed past another one of its class, or hidden.

namespace houghstream::tracks {
namespace {

using test::before_the_middle;
using test::distance;
using test::on_table;
using test::TrackedScene;

TEST(TrackerNumbers, WhatIsCarriedToAnotherPlaceKeepsItsNumber) {
  TrackedScene scene;
  scene.show({{"can", on_table(-0.2, 0)}, {"mug", on_table(0.25, 0.1)}});
  scene.frames(60);
  scene.show({{"mug", on_table(0.25, 0.1)}});
  scene.frames(60);
  scene.show({{"can", on_table(0.1, -0.1)}, {"mug", on_table(0.25, 0.1)}});
  const WorldObjects world = scene.frames(15);
  ASSERT_EQ(world.objects.size(), 2U);
  EXPECT_EQ(world.objects[0].class_name, "can");
  EXPECT_EQ(world.objects[0].track_id, 1);
  EXPECT_LT(distance(world.objects[0], on_table(0.1, -0.1)), 0.001);
}

TEST(TrackerNumbers, OfTwoThatComeTogetherOneIsThatWhichHadGone) {
  TrackedScene scene;
  scene.show({{"can", on_table(-0.2, 0)}});
  scene.frames(60);
  scene.show({});
  ASSERT_TRUE(scene.frames(120).objects.empty());
  scene.show({{"can", on_table(0, 0)}, {"can", on_table(0.2, 0)}});
  WorldObjects world;
  for (int i = 0; i < 10; ++i) {
    world = scene.frame();
    EXPECT_NE(world.objects.size(), 1U) << i;  // both have been seen as often
  }
  ASSERT_EQ(world.objects.size(), 2U);
  EXPECT_EQ(world.objects[0].track_id, 1);
  EXPECT_EQ(world.objects[1].track_id, 2);
}

TEST(TrackerNumbers, TwoEqualOnesSideBySideKeepTheirNumbersWhileOneIsPushedPastTheOther) {
  TrackedScene scene;
  scene.show({{"can", on_table(-0.1, 0)}, {"can", on_table(0, 0)}});
  const WorldObjects before = scene.frames(60);
  ASSERT_EQ(before.objects.size(), 2U);
  const std::int64_t left = distance(before.objects[0], on_table(-0.1, 0)) < 0.01 ? 1 : 2;
  WorldObjects world;
  for (int i = 0; i <= 60; ++i) {
    const double along = -0.1 + 0.3 * i / 60.0;
    scene.show({{"can", on_table(along, -0.09)}, {"can", on_table(0, 0)}});
    world = scene.frame();
  }
  world = scene.frames(20);
  ASSERT_EQ(world.objects.size(), 2U);
  EXPECT_LT(distance(world.objects[static_cast<std::size_t>(left - 1)], on_table(0.2, -0.09)), 0.003);
  EXPECT_LT(distance(world.objects[static_cast<std::size_t>(2 - left)], on_table(0, 0)), 0.003);
}

/// Two cans, of which the second stands in the middle of the table, seen one after the other.
void see_one_after_the_other(TrackedScene& scene) {
  scene.show({{"can", on_table(-0.25, 0)}});
  scene.frames(30);
  scene.standing.emplace_back("can", on_table(0, 0));
  scene.posed = {{"can", on_table(0, 0)}};
  scene.frames(30);
}

/// Shows the first can, and one in another place, while a hand hides the middle of the table.
WorldObjects see_another_while_the_second_is_hidden(TrackedScene& scene) {
  scene.show({{"can", on_table(-0.25, 0)}, {"can", on_table(0.25, 0)}});
  scene.obstacle = before_the_middle();
  return scene.frames(10);
}

TEST(TrackerNumbers, WhatAHandHidesIsWhatAppearsElsewhereAsLongAsNoMoreAreSeenThanWereSeenTogether) {
  TrackedScene scene;
  scene.show({{"can", on_table(-0.25, 0)}, {"can", on_table(0, 0)}});
  ASSERT_EQ(scene.frames(60).objects.size(), 2U);
  const WorldObjects world = see_another_while_the_second_is_hidden(scene);
  ASSERT_EQ(world.objects.size(), 2U);
  EXPECT_EQ(world.objects[1].track_id, 2);
  EXPECT_LT(distance(world.objects[1], on_table(0.25, 0)), 0.001);
}

TEST(TrackerNumbers, OneMoreThanWereEverSeenTogetherIsAnotherObjectThanTheHiddenOne) {
  TrackedScene scene;
  see_one_after_the_other(scene);
  const WorldObjects world = see_another_while_the_second_is_hidden(scene);
  ASSERT_EQ(world.objects.size(), 3U);
  EXPECT_EQ(world.objects[1].state, TrackState::kHidden) << world.objects[1].reason;
  EXPECT_LT(distance(world.objects[1], on_table(0, 0)), 0.001);
  EXPECT_EQ(world.objects[2].track_id, 3);
  EXPECT_LT(distance(world.objects[2], on_table(0.25, 0)), 0.001);
}

TEST(TrackerNumbers, HowManyWereSeenTogetherIsForgottenWithThem) {
  ObjectTrackerSettings settings;
  settings.reidentification_s = 0.5;
  TrackedScene scene(settings);
  scene.show({{"can", on_table(-0.25, 0)}, {"can", on_table(0, 0)}});
  ASSERT_EQ(scene.frames(60).objects.size(), 2U);
  scene.show({});
  ASSERT_TRUE(scene.frames(120).objects.empty());
  see_one_after_the_other(scene);
  const WorldObjects world = see_another_while_the_second_is_hidden(scene);
  ASSERT_EQ(world.objects.size(), 3U);
  EXPECT_EQ(world.objects[2].track_id, 5);
}

}  // namespace
}  // namespace houghstream::tracks
