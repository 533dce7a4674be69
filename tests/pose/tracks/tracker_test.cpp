#include "pose/tracks/tracker.hpp"

#include <gtest/gtest.h>

#include "tests/pose/tracks/tracked_scene.hpp"

namespace houghstream::tracks {
namespace {

using test::before_the_middle;
using test::camera_in_front;
using test::distance;
using test::on_table;
using test::TrackedScene;

TEST(Tracker, AnObjectIsPublishedAfterAFewFramesAFalseOneOfOneFrameNever) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  EXPECT_TRUE(scene.frame().objects.empty());
  const WorldObjects world = scene.frames(9);
  ASSERT_EQ(world.objects.size(), 1U);
  EXPECT_EQ(world.objects[0].track_id, 1);
  EXPECT_EQ(world.objects[0].class_name, "can");
  EXPECT_EQ(world.objects[0].state, TrackState::kVisible);
  EXPECT_GT(world.objects[0].probability, 0.9F);
  EXPECT_EQ(world.objects[0].seen, 10);

  TrackedScene other;
  other.posed = {{"can", on_table(0.1, 0)}};
  other.frame();
  other.posed.clear();
  EXPECT_TRUE(other.frames(60).objects.empty());
}

TEST(Tracker, WhatStandsIsAveraged) {
  TrackedScene scene;
  scene.noise_m = 0.004;
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(30);
  double square_sum = 0.0;
  for (int i = 0; i < 150; ++i) {
    const WorldObjects world = scene.frame();
    ASSERT_EQ(world.objects.size(), 1U);
    EXPECT_FALSE(world.objects[0].moving);
    square_sum += std::pow(distance(world.objects[0], on_table(0, 0)), 2);
  }
  EXPECT_LT(std::sqrt(square_sum / 150), 0.0008);  // each measurement: 0.004
}

TEST(Tracker, WhatIsSeenThroughIsGoneWithinASecondAndSaysWhy) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}, {"mug", on_table(0.2, 0)}});
  ASSERT_EQ(scene.frames(60).objects.size(), 2U);
  scene.show({{"mug", on_table(0.2, 0)}});
  const WorldObjects world = scene.frames(29);
  ASSERT_EQ(world.objects.size(), 2U);
  EXPECT_EQ(world.objects[0].state, TrackState::kGone);
  EXPECT_NE(world.objects[0].reason.find("free-space violation"), std::string::npos) << world.objects[0].reason;
  EXPECT_EQ(world.objects[1].state, TrackState::kVisible);
  EXPECT_EQ(scene.frames(90).objects.size(), 1U);  // a gone object is published for a while
}

TEST(Tracker, WhatIsHiddenIsKeptForAsLongAsItIsHidden) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(60);
  scene.posed.clear();
  scene.obstacle = before_the_middle();
  const WorldObjects world = scene.frames(300);
  ASSERT_EQ(world.objects.size(), 1U);
  EXPECT_EQ(world.objects[0].state, TrackState::kHidden);
  EXPECT_LT(distance(world.objects[0], on_table(0, 0)), 0.001);
  scene.obstacle.reset();
  scene.posed = scene.standing;
  EXPECT_EQ(scene.frames(1).objects.at(0).track_id, 1);
}

TEST(Tracker, WhatMovedBeforeItWasHiddenIsGoneAndSaysWhy) {
  TrackedScene scene;
  scene.show({{"can", on_table(-0.3, 0)}});
  scene.frames(60);
  for (int i = 1; i <= 28; ++i) {
    scene.show({{"can", on_table(-0.3 + 0.01 * i, 0)}});
    scene.frame();
  }
  scene.posed.clear();
  // The obstacle is near the camera and hides the can's whole way.
  scene.obstacle = Eigen::Isometry3d(Eigen::Translation3d(0.0, -0.51, 0.404));
  WorldObjects world;
  for (int i = 0; i < 120; ++i) {
    world = scene.frame();
    ASSERT_EQ(world.objects.size(), 1U);
    if (world.objects[0].state == TrackState::kGone) break;
  }
  EXPECT_EQ(world.objects[0].state, TrackState::kGone);
  EXPECT_EQ(world.objects[0].reason, "occluded by a nearer surface in CAMERA; it moved when it was seen last");
}

TEST(Tracker, WhenACamerasResolutionChangesWhatStandsIsStillThereAndWhatIsTakenAwayIsGone) {
  for (const double scale : {0.5, 2.0}) {
    TrackedScene scene;
    scene.show({{"can", on_table(-0.1, 0)}, {"mug", on_table(0.2, 0)}});
    scene.frames(30);
    scene.posed.clear();
    EXPECT_EQ(scene.frame().objects.at(0).state, TrackState::kUnrecognised);
    scene.camera = test::kSmall.scaled(scale);
    const WorldObjects unseen = scene.frames(10);
    ASSERT_EQ(unseen.objects.size(), 2U) << scale;
    for (const TrackedObject& object : unseen.objects)
      EXPECT_EQ(object.state, TrackState::kUnrecognised) << scale << ": " << object.reason;
    scene.show({{"mug", on_table(0.2, 0)}});
    const WorldObjects world = scene.frames(29);
    ASSERT_EQ(world.objects.size(), 2U) << scale;
    EXPECT_EQ(world.objects[0].track_id, 1);
    EXPECT_EQ(world.objects[0].state, TrackState::kGone) << scale << ": " << world.objects[0].reason;
    EXPECT_EQ(world.objects[1].track_id, 2);
    EXPECT_EQ(world.objects[1].state, TrackState::kVisible);
  }
}

TEST(Tracker, WhatIsOutOfViewIsKept) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(60);
  scene.posed.clear();
  scene.T_world_camera = camera_in_front(3.0);
  const WorldObjects world = scene.frames(300);
  ASSERT_EQ(world.objects.size(), 1U);
  EXPECT_EQ(world.objects[0].state, TrackState::kOutOfView);
  EXPECT_GT(world.objects[0].probability, 0.9F);
}

TEST(Tracker, WhatMovesIsFollowedWithItsVelocityAndStandsAgain) {
  TrackedScene scene;
  scene.show({{"can", on_table(-0.3, 0)}});
  scene.frames(60);
  WorldObjects world;
  for (int i = 1; i <= 45; ++i) {
    scene.show({{"can", on_table(-0.3 + 0.01 * i, 0)}});
    world = scene.frame();
    if (i > 10) {
      EXPECT_LT(distance(world.objects.at(0), on_table(-0.3 + 0.01 * i, 0)), 0.004) << i;
    }
  }
  EXPECT_TRUE(world.objects.at(0).moving);
  EXPECT_NEAR(world.objects.at(0).velocity.x(), 0.3, 0.03);
  world = scene.frames(30);
  EXPECT_FALSE(world.objects.at(0).moving);
  EXPECT_EQ(world.objects.at(0).velocity.norm(), 0.0);
  EXPECT_EQ(world.objects.at(0).track_id, 1);
}

TEST(Tracker, MoreObjectsThanAllowedAreRefusedAndTheOthersToldOf) {
  ObjectTrackerSettings settings;
  settings.max_objects = 2;
  TrackedScene scene(settings);
  scene.show({{"can", on_table(-0.3, 0)}, {"can", on_table(0, 0)}, {"can", on_table(0.3, 0)}});
  EXPECT_EQ(scene.frames(10).objects.size(), 2U);
  EXPECT_EQ(scene.tracker.refused(), 1U);
  scene.show({{"can", on_table(-0.3, 0)}, {"can", on_table(0, 0)}});
  scene.frame();
  EXPECT_EQ(scene.tracker.refused(), 0U);
}

TEST(Tracker, WhatHasBeenGoneLongestMakesRoom) {
  ObjectTrackerSettings settings;
  settings.max_objects = 1;
  TrackedScene scene(settings);
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(60);
  scene.show({});
  ASSERT_TRUE(scene.frames(120).objects.empty());  // and stored for reidentification
  scene.show({{"mug", on_table(0.2, 0)}});
  const WorldObjects world = scene.frames(10);
  ASSERT_EQ(world.objects.size(), 1U);
  EXPECT_EQ(world.objects[0].class_name, "mug");
  EXPECT_EQ(scene.tracker.refused(), 0U);
}

}  // namespace
}  // namespace houghstream::tracks
