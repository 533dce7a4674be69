#include "pose/tracks/extrinsic_check.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/pose/tracks/tracked_scene.hpp"

namespace houghstream::tracks {
namespace {

using test::foot;
using test::half_turn;
using test::models_on_foot;
using test::on_table;
using test::TrackedScene;

ExtrinsicCheck after_frames(const Eigen::Vector3d& wrong_m) {
  TrackedScene scene;
  scene.noise_m = 0.003;
  scene.show({{"can", on_table(-0.1, 0)}, {"can", on_table(0.05, 0.1)}, {"mug", on_table(0.2, 0)}});
  ExtrinsicCheck check;
  for (int i = 0; i < 30; ++i) {
    scene.utime += test::kFrameUs;
    scene.channel = "LEFT";
    check.add(scene.poses(), scene.T_world_camera, {});
    scene.channel = "RIGHT";
    const ObjectPoses poses = scene.poses();
    check.add(poses, Eigen::Translation3d(wrong_m) * scene.T_world_camera, {});
  }
  return check;
}

TEST(ExtrinsicCheck, CamerasThatAgreeAreNotReported) {
  const ExtrinsicCheck check = after_frames(Eigen::Vector3d::Zero());
  ASSERT_EQ(check.pairs().size(), 1U);
  EXPECT_LT(check.pairs()[0].offset_m.norm(), 0.003);
  EXPECT_TRUE(check.inconsistencies().empty());
}

TEST(ExtrinsicCheck, TwoCentimetresAreReportedWithTheirDirection) {
  const ExtrinsicCheck check = after_frames({0.0, 0.02, 0.0});
  ASSERT_EQ(check.inconsistencies().size(), 1U);
  const ExtrinsicInconsistency found = check.inconsistencies()[0];
  EXPECT_EQ(found.first, "LEFT");
  EXPECT_EQ(found.second, "RIGHT");
  EXPECT_NEAR(found.offset_m.y(), 0.02, 0.003);
}

TEST(ExtrinsicCheck, CamerasThatSeeAnObjectInTwoPosesThatLookTheSameAgree) {
  const TrackModels models = models_on_foot();
  TrackedScene scene;
  ExtrinsicCheck check;
  for (int i = 0; i < 30; ++i) {
    scene.utime += test::kFrameUs;
    scene.channel = "LEFT";
    scene.posed = {{"can", on_table(0, 0) * foot()}};
    check.add(scene.poses(), scene.T_world_camera, models);
    scene.channel = "RIGHT";
    scene.posed = {{"can", on_table(0, 0) * foot() * half_turn()}};
    check.add(scene.poses(), scene.T_world_camera, models);
  }
  ASSERT_EQ(check.pairs().size(), 1U);
  EXPECT_LT(check.pairs()[0].offset_m.norm(), 1e-6);
}

TEST(ExtrinsicCheck, FramesThatAreAsFarApartAsTimesCanBeAreNotCompared) {
  TrackedScene scene;
  scene.show({{"can", on_table(0, 0)}});
  ExtrinsicCheck check;
  for (int i = 0; i < 30; ++i) {
    scene.channel = "LEFT";
    scene.utime = std::numeric_limits<std::int64_t>::min();
    check.add(scene.poses(), scene.T_world_camera, {});
    scene.channel = "RIGHT";
    scene.utime = std::numeric_limits<std::int64_t>::max();
    check.add(scene.poses(), scene.T_world_camera, {});
  }
  EXPECT_TRUE(check.pairs().empty());
}

}  // namespace
}  // namespace houghstream::tracks
