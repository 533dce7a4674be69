#include "pose/registration/rotation_search.hpp"

#include <gtest/gtest.h>

#include "pose/model/angles.hpp"
#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

const DepthTolerance kTolerance{0.008, {}};

double angle_between_deg(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() / kRadPerDeg;
}

struct SeenBox {
  ObjectModel model = make_object_model("box", printed_box(), {});
  Eigen::Isometry3d truth = standing(25.0, 30.0, 0.8);
  RgbdFrame frame = coloured_frame(model.mesh, truth, 3);
  ObjectObservation seen{frame, model};

  SeenBox() {
    seen.centre_camera = truth.translation().cast<float>();
    seen.colours = lab_region(frame, {0, 0, 640, 480}, {});
  }
};

TEST(TurnSearch, FindsTheWayBackFromEveryQuarter) {
  const SeenBox box;
  for (const double degrees : {90.0, 180.0, 270.0}) {
    const auto rotations = best_rotations_about_z(box.seen, rotated(box.truth, degrees),
                                                  {15.0 * kRadPerDeg, 180.0 * kRadPerDeg, 3, 250}, kTolerance);
    ASSERT_FALSE(rotations.empty());
    EXPECT_LT(angle_between_deg(rotations.front().T_camera_object, box.truth), 1.0) << degrees;
  }
}

TEST(TurnSearch, TheBestComesFirstAndNeighboursOfABetterOneAreLeftOut) {
  const SeenBox box;
  const auto rotations =
      best_rotations_about_z(box.seen, box.truth, {5.0 * kRadPerDeg, 180.0 * kRadPerDeg, 4, 250}, kTolerance);
  ASSERT_LE(rotations.size(), 4U);
  for (std::size_t i = 1; i < rotations.size(); ++i) {
    EXPECT_GE(rotations[i - 1].score, rotations[i].score);
    EXPECT_GT(angle_between_deg(rotations[i - 1].T_camera_object, rotations[i].T_camera_object), 6.0);
  }
}

TEST(TurnSearch, AHandleDoesNotMoveTheAxis) {
  EXPECT_LT(make_object_model("mug", mug(), {}).surface_median.head<2>().norm(), 0.004F);
  EXPECT_GT(make_object_model("mug", mug(), {}).centre.head<2>().norm(), 0.01F);
}

TEST(TurnSearch, ClimbsBackFromASmallTurnAndShift) {
  const SeenBox box;
  Eigen::Isometry3d start = rotated(box.truth, 5.0);
  start.translate(Eigen::Vector3d(0.0, 0.0, 0.004));
  const HillClimb hill_climb{3.0 * kRadPerDeg, 0.004, 5, 250};
  const ScoredPose top = hill_climb_pose(box.seen, start, hill_climb, kTolerance);
  EXPECT_GT(top.score, score_pose_jointly(box.seen, start, 250, kTolerance).score);
  EXPECT_LT(angle_between_deg(top.T_camera_object, box.truth), 3.0);
}

}  // namespace
}  // namespace houghstream
