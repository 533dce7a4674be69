#include "pose/tracks/tracker.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/pose/tracks/tracked_scene.hpp"

namespace houghstream::tracks {
namespace {

using test::before_the_middle;
using test::block;
using test::block_on_foot;
using test::camera_in_front;
using test::distance;
using test::foot;
using test::half_turn;
using test::models_on_foot;
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
  EXPECT_NE(world.objects[0].reason.find("sees through"), std::string::npos) << world.objects[0].reason;
  EXPECT_EQ(world.objects[1].state, TrackState::kVisible);
  EXPECT_EQ(scene.frames(90).objects.size(), 1U);  // gone is told for a while
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
  // Near the camera: it hides all of the can's way.
  scene.obstacle = Eigen::Isometry3d(Eigen::Translation3d(0.0, -0.51, 0.404));
  WorldObjects world;
  for (int i = 0; i < 120; ++i) {
    world = scene.frame();
    ASSERT_EQ(world.objects.size(), 1U);
    if (world.objects[0].state == TrackState::kGone) break;
  }
  EXPECT_EQ(world.objects[0].state, TrackState::kGone);
  EXPECT_EQ(world.objects[0].reason, "something stands before it in CAMERA; it moved when it was seen last");
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

TEST(Tracker, APoseThatLooksTheSameIsOfTheSameObjectWhereverItsOriginIs) {
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

TEST(Tracker, WhereAnObjectStandsNoneOfItsClassStandsOnItsHead) {
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

TEST(Tracker, WhereAnotherClassIsRecognisedAnObjectGoesWhereverTheirOriginsAre) {
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

TEST(Tracker, WhatHasTwoTurnsDoesNotSpinWhenItIsPushed) {
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

TEST(Tracker, WhatMovesIsWhereItIsNowThoughAnotherCamerasFrameIsOlder) {
  TrackedScene scene;
  scene.channel = "LEFT";
  scene.show({{"can", on_table(-0.4, 0)}});
  scene.frames(60);
  constexpr std::int64_t kOlderUs = 30000;
  constexpr double kOlderFrames = static_cast<double>(kOlderUs) / static_cast<double>(test::kFrameUs);
  constexpr double kStepM = 0.015;  // from frame to frame
  for (int i = 1; i <= 40; ++i) {
    const Eigen::Isometry3d here = on_table(-0.4 + kStepM * i, 0);
    scene.channel = "LEFT";
    scene.show({{"can", here}});
    scene.frame();
    scene.channel = "RIGHT";
    scene.utime -= kOlderUs;
    scene.show({{"can", on_table(-0.4 + kStepM * (i - kOlderFrames), 0)}});
    const WorldObjects world = scene.look();
    scene.utime += kOlderUs;
    if (i > 15) {
      EXPECT_LT(distance(world.objects.at(0), here), 0.004) << i;
    }
  }
}

TEST(Tracker, OnePoseElsewhereTellsWhereDepthHasDoubted) {
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

TEST(Tracker, TwoTurnsOfAnObjectAreNeverAveraged) {
  TrackedScene scene;
  for (int i = 0; i < 120; ++i) {
    scene.show({{"can", on_table(0, 0, i % 3 == 0 ? 2.0 : 0.0)}});
    const WorldObjects world = scene.frame();
    if (world.objects.empty()) continue;
    const Eigen::AngleAxisd turn(world.objects[0].T_world_object.linear());
    EXPECT_TRUE(turn.angle() < 0.01 || std::abs(turn.angle() - 2.0) < 0.01) << i << ": " << turn.angle();
    if (i > 30) {
      EXPECT_LT(turn.angle(), 0.01) << i;
    }
  }
}

TEST(Tracker, CamerasThatDisagreeByTwoCentimetresSeeOneObjectThatStands) {
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

TEST(Tracker, ATimeThatGoesBackBeginsANewWorldALateFrameIsPassedOver) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  EXPECT_EQ(scene.frames(30).world_number, 1);
  scene.utime -= 2 * test::kFrameUs;
  EXPECT_FALSE(scene.tracker.update({scene.poses(), nullptr, scene.T_world_camera, nullptr}).has_value());
  scene.utime -= 100000000;
  const WorldObjects world = scene.frame();
  EXPECT_EQ(world.world_number, 2);
  EXPECT_TRUE(world.objects.empty());
}

TEST(Tracker, AWorldMayBeginAtTimeZero) {
  std::vector<WorldObjects> worlds;
  for (const std::int64_t begin : {std::int64_t{1000000000}, std::int64_t{0}}) {
    TrackedScene scene;
    scene.utime = begin - test::kFrameUs;
    scene.show({{"can", on_table(0, 0)}});
    worlds.push_back(scene.frames(4));
    ASSERT_EQ(worlds.back().objects.size(), 1U) << begin;
  }
  EXPECT_EQ(worlds[0].objects[0].probability, worlds[1].objects[0].probability);
}

TEST(Tracker, AClassThatAFrameWasToldOfIsNotToldAgain) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  for (int i = 0; i < 30; ++i) {
    scene.frame();
    scene.posed = {{"can", on_table(0.3, 0)}};  // the same frame once more, by somebody else
    EXPECT_LE(scene.look().objects.size(), 1U);
    scene.posed = scene.standing;
  }
}

TEST(Tracker, WhatOneResultOfAFrameHasSeenAnotherDoesNotMiss) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(30);
  scene.posed.clear();
  EXPECT_EQ(scene.look().objects.at(0).state, TrackState::kVisible);
  EXPECT_EQ(scene.frame().objects.at(0).state, TrackState::kUnrecognised);
}

TEST(Tracker, WhatASecondDetectorSeesIsAsSoonSureAsWhatTheFirstOneSees) {
  TrackedScene scene;
  scene.standing = {{"can", on_table(0, 0)}, {"mug", on_table(0.2, 0)}};
  WorldObjects world;
  for (int i = 0; i < 5; ++i) {
    scene.posed = {{"can", on_table(0, 0)}};
    scene.frame();
    scene.posed = {{"mug", on_table(0.2, 0)}};
    world = scene.look();
  }
  EXPECT_EQ(world.objects.size(), 2U);
}

TEST(Tracker, WhatAnotherDetectorIsSlowToLookForIsNotMissedByTheFirstOne) {
  TrackedScene scene;
  scene.standing = {{"can", on_table(0, 0)}, {"mug", on_table(0.2, 0)}};
  WorldObjects world;
  const auto told = [&](const std::string& name, double x) {
    scene.posed = {{name, on_table(x, 0)}};
    world = scene.look();
  };
  for (int i = 0; i < 12; ++i) {
    scene.utime += 100000;
    told("mug", 0.2);
    if (i % 3 == 0) told("can", 0);
  }
  ASSERT_EQ(world.objects.size(), 2U) << "in two of three frames nobody has looked for the can";
  const std::size_t can = world.objects[0].class_name == "can" ? 0 : 1;
  EXPECT_EQ(world.objects[can].state, TrackState::kVisible);
  const float before = world.objects[can].probability;
  for (int i = 0; i < 20; ++i) {
    scene.utime += 100000;
    told("mug", 0.2);
  }
  ASSERT_EQ(world.objects.size(), 2U);
  EXPECT_EQ(world.objects[can].state, TrackState::kUnrecognised) << "its detector is silent";
  EXPECT_LT(world.objects[can].probability, before);
}

TEST(Tracker, MoreObjectsThanAllowedAreRefusedAndTheOthersToldOf) {
  TrackerSettings settings;
  settings.most_objects = 2;
  TrackedScene scene(settings);
  scene.show({{"can", on_table(-0.3, 0)}, {"can", on_table(0, 0)}, {"can", on_table(0.3, 0)}});
  EXPECT_EQ(scene.frames(10).objects.size(), 2U);
  EXPECT_EQ(scene.tracker.refused(), 1U);
  scene.show({{"can", on_table(-0.3, 0)}, {"can", on_table(0, 0)}});
  scene.frame();
  EXPECT_EQ(scene.tracker.refused(), 0U);
}

TEST(Tracker, WhatHasBeenGoneLongestMakesRoom) {
  TrackerSettings settings;
  settings.most_objects = 1;
  TrackedScene scene(settings);
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(60);
  scene.show({});
  ASSERT_TRUE(scene.frames(120).objects.empty());  // and remembered
  scene.show({{"mug", on_table(0.2, 0)}});
  const WorldObjects world = scene.frames(10);
  ASSERT_EQ(world.objects.size(), 1U);
  EXPECT_EQ(world.objects[0].class_name, "mug");
  EXPECT_EQ(scene.tracker.refused(), 0U);
}

TEST(Tracker, AResultThatTakesLongIsNoNewWorld) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(30);
  const std::int64_t now = scene.utime;
  scene.utime -= 3000000;
  const ObjectPoses late = scene.poses();
  EXPECT_FALSE(scene.tracker.update({late, nullptr, scene.T_world_camera, nullptr, now}).has_value());
  scene.utime = now;
  const WorldObjects world = scene.frame();
  EXPECT_EQ(world.world_number, 1);
  EXPECT_EQ(world.objects.size(), 1U);
}

TEST(Tracker, ACameraWhoseClockIsBehindIsRefusedAndTheWorldGoesOn) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  for (int i = 0; i < 60; ++i) {
    scene.channel = "LEFT";
    EXPECT_EQ(scene.frame().world_number, 1);
    scene.channel = "RIGHT";
    scene.utime -= 10000000;
    EXPECT_THROW(scene.look(), InputError);
    scene.utime += 10000000;
  }
}

TEST(Tracker, TheSameFramesGiveTheSameObjectsBitForBit) {
  std::vector<WorldObjects> runs;
  for (int run = 0; run < 2; ++run) {
    TrackedScene scene;
    scene.noise_m = 0.004;
    scene.show({{"can", on_table(0, 0)}, {"can", on_table(0.1, 0)}, {"mug", on_table(-0.2, 0.1)}});
    runs.push_back(scene.frames(50));
  }
  ASSERT_EQ(runs[0].objects.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(runs[0].objects[i].track_id, runs[1].objects[i].track_id);
    EXPECT_EQ(runs[0].objects[i].T_world_object.matrix(), runs[1].objects[i].T_world_object.matrix());
    EXPECT_EQ(runs[0].objects[i].covariance, runs[1].objects[i].covariance);
  }
}

}  // namespace
}  // namespace houghstream::tracks
