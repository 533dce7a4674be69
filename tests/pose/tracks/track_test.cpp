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
