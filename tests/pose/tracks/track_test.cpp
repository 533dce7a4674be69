#include "pose/tracks/track.hpp"

#include <gtest/gtest.h>

#include "tests/pose/tracks/tracked_scene.hpp"

namespace houghstream::tracks {
namespace {

using test::block;
using test::foot;
using test::half_turn;
using test::models_on_foot;
using test::on_table;
using test::TrackedScene;

PoseObservation seen_can(const Eigen::Isometry3d& T_world_object, const TrackModels& models) {
  TrackedScene scene;
  scene.posed = {{"can", T_world_object}};
  return observe_poses(scene.poses(), scene.T_world_camera, models).at(0);
}

TEST(Track, TheCentreIsThatOfTheBoxOrTheOriginWithoutAModel) {
  EXPECT_LT((centre_of(models_on_foot(), "can") - Eigen::Vector3d(0, 0, 0.06)).norm(), 1e-6);
  EXPECT_EQ(centre_of(models_on_foot(), "mug"), Eigen::Vector3d(0, 0, 0));
}

TEST(Track, BoxesAndNamedFramesMoveWithTheirObjects) {
  TrackModels models = models_on_foot();
  models.at("can").frames.push_back({"lid", Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.12))});
  WorldObjects world;
  world.frame = {"LEFT", 5};
  world.world = "WORLD";
  world.world_number = 3;
  for (const char* name : {"can", "mug", "can"}) {
    TrackedObject& object = world.objects.emplace_back();
    object.track_id = static_cast<std::int64_t>(world.objects.size());
    object.class_name = name;
    object.state = TrackState::kVisible;
    object.T_world_object = on_table(0.1, 0.2) * foot() * half_turn();
  }
  world.objects[2].state = TrackState::kGone;
  const ObjectPlacements placed = place_objects(world, models);
  EXPECT_EQ(placed.frame, world.frame);
  EXPECT_EQ(placed.world, "WORLD");
  EXPECT_EQ(placed.world_number, 3);
  ASSERT_EQ(placed.objects.size(), 1U) << "a mug has no model, and the other can is gone";
  const ObjectPlacement& can = placed.objects[0];
  const Eigen::Isometry3d& T = world.objects[0].T_world_object;
  EXPECT_EQ(can.track_id, 1);
  EXPECT_LT((can.T_world_box.translation() - T * Eigen::Vector3d(0, 0, 0.06)).norm(), 1e-6);
  EXPECT_TRUE(can.T_world_box.linear().isApprox(T.linear()));
  EXPECT_LT((can.box_size - mesh_bounds(models.at("can").mesh).sizes().cast<double>()).norm(), 1e-9);
  ASSERT_EQ(can.frames.size(), 1U);
  EXPECT_EQ(can.frames[0].name, "lid");
  EXPECT_LT((can.frames[0].T_world_frame.translation() - T * Eigen::Vector3d(0, 0, 0.12)).norm(), 1e-9);
}

TEST(Track, APosesCovarianceIsThatOfWhereTheObjectIsNotOfWhereItsOriginIs) {
  const PoseObservation middle = seen_can(on_table(0, 0), make_track_models({{"can", block()}}, {}));
  const PoseObservation at_foot = seen_can(on_table(0, 0) * foot(), models_on_foot());
  EXPECT_TRUE(at_foot.measured.covariance.isApprox(middle.measured.covariance, 1e-4));
}

TEST(Track, TheDistanceIsThatOfTheCentresOfPosesThatLookTheSame) {
  const TrackModels models = models_on_foot();
  const TrackModel& can = models.at("can");
  const Eigen::Isometry3d upright = on_table(0, 0) * foot();
  const PoseTrack track(seen_can(upright, models), {});
  const PoseMeasurement on_head = seen_can(upright * half_turn(), models).measured;
  const PoseMeasurement aside = seen_can(on_table(0.05, 0) * foot() * half_turn(), models).measured;
  EXPECT_NEAR(track.distance(on_head, can.symmetries, can.centre), 0.0, 1e-6);
  EXPECT_NEAR(track.distance(on_head, {}, can.centre), 0.0, 1e-6);
  EXPECT_NEAR(track.distance(aside, can.symmetries, can.centre), 0.05, 1e-6);
  // The half turn brings back what lies beside the middle.
  EXPECT_NEAR(track.distance(on_head, can.symmetries, Eigen::Vector3d::Zero()), 0.0, 1e-6);
  EXPECT_NEAR(track.distance(on_head, {}, Eigen::Vector3d::Zero()), 0.12, 1e-6);
}

}  // namespace
}  // namespace houghstream::tracks
