#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "pose/tracks/tracker.hpp"
#include "tests/pose/tracks/tracked_scene.hpp"

namespace houghstream::tracks {
namespace {

using test::distance;
using test::on_table;
using test::TrackedScene;

TEST(TrackerResults, WhatMovesIsWhereItIsNowThoughAnotherCamerasFrameIsOlder) {
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

TEST(TrackerResults, ATimeThatGoesBackBeginsANewWorldALateFrameIsPassedOver) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  EXPECT_EQ(scene.frames(30).world_number, 1);
  scene.utime -= 2 * test::kFrameUs;
  EXPECT_FALSE(scene.tracker.update({scene.poses(), nullptr, scene.T_world_camera, nullptr}).has_value());
  scene.utime -= 100000000;
  EXPECT_FALSE(scene.look_if_any().has_value()) << "one stamp may be wrong";
  const WorldObjects world = scene.frame();
  EXPECT_EQ(world.world_number, 2);
  EXPECT_TRUE(world.objects.empty());
}

/// A scene of which a can is seen, and whose frames have numbers.
class NumberedScene {
 public:
  NumberedScene() {
    scene.show({{"can", on_table(0, 0)}, {"mug", on_table(0.2, 0)}});
    for (int i = 0; i < 30; ++i) world = frame();
  }
  std::optional<WorldObjects> frame() {
    scene.utime += test::kFrameUs;
    scene.number = {number++, scene.utime, 7};
    return scene.look_if_any();
  }

  TrackedScene scene;
  std::optional<WorldObjects> world;
  std::int64_t number = 0;
};

TEST(TrackerResults, AClockThatIsSetLeavesTheObjectsAndTheirNumbers) {
  constexpr std::int64_t kHourUs = 3600000000;
  for (const std::int64_t step : {-kHourUs, kHourUs}) {
    NumberedScene it;
    it.scene.utime += step;
    EXPECT_FALSE(it.frame().has_value());
    for (int i = 0; i < 30; ++i) {
      const std::optional<WorldObjects> world = it.frame();
      ASSERT_TRUE(world.has_value()) << step << " " << i;
      EXPECT_EQ(world->world_number, 1);
      EXPECT_EQ(world->frame, (FrameId{"CAMERA", it.scene.utime}));
      ASSERT_EQ(world->objects.size(), 2U);
      EXPECT_EQ(world->objects[0].last_seen, world->frame);
      EXPECT_EQ(world->objects[0].track_id, it.world->objects[0].track_id);
      EXPECT_LT(distance(world->objects[0], on_table(0, 0)), 0.001);
      const double known_s = seconds_between(world->objects[0].first_utime, it.scene.utime);
      EXPECT_GT(known_s, 0.5);
      EXPECT_LT(known_s, 70.0) << "its times go with the clock";
    }
    it.scene.show({{"mug", on_table(0.2, 0)}});
    std::optional<WorldObjects> world;
    for (int i = 0; i < 30; ++i) world = it.frame();
    ASSERT_EQ(world->objects.size(), 2U);
    EXPECT_EQ(world->objects[0].state, TrackState::kGone) << "what is taken away is noticed as before";
    EXPECT_EQ(world->objects[1].state, TrackState::kVisible);
  }
}

TEST(TrackerResults, OneFrameDatedAYearAheadOrBackChangesNothing) {
  constexpr std::int64_t kYearUs = 8760 * std::int64_t{3600000000};
  NumberedScene without;
  without.frame();
  const std::optional<WorldObjects> expected = without.frame();
  for (const std::int64_t wrong : {kYearUs, -kYearUs}) {
    NumberedScene it;
    it.frame();
    it.scene.utime += wrong;
    EXPECT_FALSE(it.frame().has_value());
    it.scene.utime -= wrong + test::kFrameUs;
    const std::optional<WorldObjects> world = it.frame();
    ASSERT_TRUE(world.has_value());
    EXPECT_EQ(world->world_number, 1);
    ASSERT_EQ(world->objects.size(), expected->objects.size());
    for (std::size_t i = 0; i < world->objects.size(); ++i) {
      EXPECT_EQ(world->objects[i].track_id, expected->objects[i].track_id);
      EXPECT_EQ(world->objects[i].probability, expected->objects[i].probability);
      EXPECT_EQ(world->objects[i].covariance, expected->objects[i].covariance);
      EXPECT_EQ(world->objects[i].seen, expected->objects[i].seen);
    }
  }
}

TEST(TrackerResults, AWorldMayBeginAtTimeZero) {
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

TEST(TrackerResults, AClassThatAFrameWasToldOfIsNotToldAgain) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  for (int i = 0; i < 30; ++i) {
    scene.frame();
    scene.posed = {{"can", on_table(0.3, 0)}};  // another result of the same frame
    EXPECT_LE(scene.look().objects.size(), 1U);
    scene.posed = scene.standing;
  }
}

TEST(TrackerResults, WhatOneResultOfAFrameHasSeenAnotherDoesNotMiss) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  scene.frames(30);
  scene.posed.clear();
  EXPECT_EQ(scene.look().objects.at(0).state, TrackState::kVisible);
  EXPECT_EQ(scene.frame().objects.at(0).state, TrackState::kUnrecognised);
}

TEST(TrackerResults, WhatASecondDetectorSeesIsAsSoonSureAsWhatTheFirstOneSees) {
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

TEST(TrackerResults, WhatAnotherDetectorIsSlowToLookForIsNotMissedByTheFirstOne) {
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

TEST(TrackerResults, AResultThatTakesLongIsNoNewWorld) {
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

TEST(TrackerResults, ACameraWhoseClockIsBehindIsRefusedAndTheWorldGoesOn) {
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

TEST(TrackerResults, TheSameFramesGiveTheSameObjectsBitForBit) {
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
