#include "pose/seen/depth_score.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

const DepthTolerance kEightMillimetres{0.008, DepthNoise()};

struct MugOnTable {
  Mesh object = mug();
  Mesh ground = table();
  Eigen::Isometry3d truth = standing(60.0, 30.0, 0.9);
  RgbdFrame frame = noisy_frame({{&object, truth, 1}, {&ground, truth* Eigen::Translation3d(0, 0, -0.05), 2}}, 1);
  ObjectModel model = make_object_model("mug", object, ModelSettings());
};

TEST(DepthScore, TruthScoresHighestAndMovesLowerIt) {
  const MugOnTable scene;
  const DepthScore truth = score_pose(scene.frame, scene.model, scene.truth, 400, kEightMillimetres);
  EXPECT_GT(truth.inlier_fraction, 0.7F);
  EXPECT_LT(truth.free_space_violation, 0.05F);
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Isometry3d moved = perturbed(scene.truth, 10.0, 0.02, random);
    EXPECT_LT(score_pose(scene.frame, scene.model, moved, 400, kEightMillimetres).value, truth.value);
  }
}

TEST(DepthScore, InFrontViolatesBehindAndUnknownAreNeutral) {
  const MugOnTable scene;
  Eigen::Isometry3d nearer = scene.truth;
  nearer.translation() *= 0.8;
  EXPECT_GT(score_pose(scene.frame, scene.model, nearer, 400, kEightMillimetres).free_space_violation, 0.9F);
  Eigen::Isometry3d farther = scene.truth;
  farther.translation() *= 1.2;
  const DepthScore behind = score_pose(scene.frame, scene.model, farther, 400, kEightMillimetres);
  EXPECT_LT(behind.free_space_violation, 0.1F);
  EXPECT_LT(behind.inlier_fraction, 0.1F);
  RgbdFrame blind = scene.frame;
  blind.depth.setTo(std::nanf(""));
  EXPECT_EQ(score_pose(blind, scene.model, scene.truth, 400, kEightMillimetres).value, 0.0F);
  Eigen::Isometry3d outside = scene.truth;
  outside.translation() = Eigen::Vector3d(0, 0, -1);
  EXPECT_EQ(score_pose(scene.frame, scene.model, outside, 400, kEightMillimetres).value, 0.0F);
}

TEST(DepthScore, ShiftAlongTheRayIsFound) {
  const MugOnTable scene;
  for (const double off : {-0.04, 0.0, 0.03}) {
    Eigen::Isometry3d moved = scene.truth;
    moved.translation() *= (moved.translation().z() + off) / moved.translation().z();
    const DepthShift found = best_depth_shift(scene.frame, scene.model, moved, {200, 0.06, kEightMillimetres});
    EXPECT_NEAR(found.shift_m, -off, 0.006);
    EXPECT_GT(found.score.inlier_fraction, 0.6F);
  }
  RgbdFrame blind = scene.frame;
  blind.depth.setTo(std::nanf(""));
  EXPECT_EQ(best_depth_shift(blind, scene.model, scene.truth, {200, 0.06, kEightMillimetres}).shift_m, 0.0);
}

const Eigen::Isometry3d kStanding = standing(30.0, 30.0, 0.8);

TEST(ProjectedView, AtTheTruePoseDepthIsThatOfTheModel) {
  const Mesh box = printed_box();
  const ObjectModel model = make_object_model("box", box, {});
  const RgbdFrame frame = coloured_frame(box, kStanding, 1);
  const ProjectedView projected = project_view(frame, model, kStanding, 300);
  ASSERT_EQ(projected.points.size(), 300U);
  int near = 0;
  for (std::size_t i = 0; i < projected.points.size(); ++i) {
    const ProjectedPoint& look = projected.points[i];
    near += std::abs(look.depth_difference) < 0.01F ? 1 : 0;
    const Eigen::Vector2d pixel = frame.camera.project(kStanding * projected.view.points[i].cast<double>());
    EXPECT_LE(std::abs(pixel.x() - look.x), 0.501);
    EXPECT_LE(std::abs(pixel.y() - look.y), 0.501);
  }
  EXPECT_GT(near, 270);
}

TEST(ProjectedView, OutsideTheImageAndWithoutDepthNothingIsKnown) {
  const Mesh box = printed_box();
  const ObjectModel model = make_object_model("box", box, {});
  RgbdFrame frame = coloured_frame(box, kStanding, 1);
  const Eigen::Isometry3d aside = Eigen::Translation3d(5.0, 0.0, 0.0) * kStanding;
  for (const ProjectedPoint& look : project_view(frame, model, aside, 50).points)
    EXPECT_TRUE(std::isnan(look.depth_difference));
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  for (const ProjectedPoint& look : project_view(frame, model, kStanding, 50).points)
    EXPECT_TRUE(std::isnan(look.depth_difference));
}

}  // namespace
}  // namespace houghstream
