#include "tools/render/world/takes/take.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

TakePlan short_plan(TakeKind kind) {
  TakePlan plan;
  plan.object_id = 108;  // a tin
  plan.kind = kind;
  plan.use = DatasetSplit::kTraining;
  plan.seconds = 6.0;
  return plan;
}

double rotated_between(const RenderedFrame& a, const RenderedFrame& b) {
  const Eigen::Matrix3d R =
      a.objects.at(0).T_camera_object.linear().transpose() * b.objects.at(0).T_camera_object.linear();
  return Eigen::AngleAxisd(R).angle();
}

TEST(RenderedTake, TheTruthIsWhereTheObjectIsSeen) {
  const RenderedTake take(short_plan(TakeKind::kHandHeld), 61, 1);
  const RenderedFrame frame = take.render(23);
  ASSERT_EQ(frame.objects.size(), 1U);
  EXPECT_EQ(frame.objects[0].object_id, 108);
  const Mesh mesh = make_taught_object(108).thing->mesh;
  cv::Mat silhouette = render_depth(mesh, frame.objects[0].T_camera_object, frame.frame.camera, {0, 0, 640, 480});
  silhouette = silhouette == silhouette;  // NaN differs from itself
  const double both = cv::countNonZero(silhouette & frame.visible_masks[0]);
  const double either = cv::countNonZero(silhouette | frame.visible_masks[0]);
  EXPECT_GT(both / either, 0.97) << "but for the rolling shutter";
}

TEST(RenderedTake, SameArgumentsSameFrameAndOtherThreads) {
  const RenderedFrame one = RenderedTake(short_plan(TakeKind::kTurntable), 31, 1).render(9);
  const RenderedFrame other = RenderedTake(short_plan(TakeKind::kTurntable), 31, 2).render(9);
  EXPECT_EQ(cv::norm(one.frame.colour, other.frame.colour, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(one.frame.depth, other.frame.depth, cv::NORM_INF), 0.0);
}

TEST(RenderedTake, ATurntableTurnsTheObjectALittleMoreThanOnceBeforeACameraThatStands) {
  const TakeStage stage(short_plan(TakeKind::kTurntable));
  World world = stage.world();
  const Eigen::Isometry3d T_camera_world = stage.move(world, 0.0);
  EXPECT_TRUE(stage.move(world, 4.0).isApprox(T_camera_world));
  const RenderedTake take(short_plan(TakeKind::kTurntable), 31, 1);
  EXPECT_NEAR(rotated_between(take.render(0), take.render(30)), 0.25, 1e-6);
  EXPECT_GT(rotated_between(take.render(0), take.render(15)), 1.5);
}

TEST(RenderedTake, AHandTurnsTheObjectAndIsAwayBetween) {
  const TakeStage stage(short_plan(TakeKind::kHandTurns));
  const auto hidden_and_turn = [&](double seconds) {
    World world = stage.world();
    const Eigen::Isometry3d T_camera_world = stage.move(world, seconds);
    const ShadedView view = shade_view({world, std::vector<ShadowMap>(world.lights.size())},
                                       synthetic_camera().scaled(0.25), T_camera_world);
    bool hand = false;
    for (std::size_t i = 0; i < world.items.size(); ++i) {
      if (world.items[i].thing->name == "hand")
        hand = hand || cv::countNonZero(view.geometry.id == static_cast<double>(i + 1)) > 20;
    }
    return hand;
  };
  EXPECT_FALSE(hidden_and_turn(0.0));
  EXPECT_TRUE(hidden_and_turn(0.4)) << "in the middle of the first of six strokes of a second";
  EXPECT_FALSE(hidden_and_turn(0.95));
  EXPECT_TRUE(hidden_and_turn(1.4));
  const RenderedTake take(short_plan(TakeKind::kHandTurns), 31, 1);
  EXPECT_NEAR(rotated_between(take.render(0), take.render(30)), 0.25, 1e-6);
}

TEST(TakePlans, TwelveObjectsTwiceInRoomsOfTheirOwn) {
  const std::vector<NumberedTake> takes = twelve_objects_takes(DatasetSplit::kTest, 0, 16.0);
  ASSERT_EQ(takes.size(), 24U);
  for (std::size_t i = 0; i < takes.size(); ++i) {
    EXPECT_EQ(takes[i].scene, static_cast<int>(i) + 1);
    EXPECT_EQ(takes[i].plan.laid_down, i % 2 == 1);
    EXPECT_EQ(takes[i].plan.number, i / 2);
  }
  EXPECT_EQ(twelve_objects_takes(DatasetSplit::kTest, 1, 16.0).front().plan.number, 12U);
}

TEST(TakeStage, TheSecondTakeIsOfTheSameRoomWithTheObjectLaidDown) {
  TakePlan plan = short_plan(TakeKind::kHandHeld);
  const TakeStage upright(plan);
  plan.laid_down = true;
  const TakeStage lying(plan);
  ASSERT_EQ(upright.world().items.size(), lying.world().items.size());
  const PlacedAsset& first = upright.world().items.back();
  const PlacedAsset& second = lying.world().items.back();
  EXPECT_EQ(first.object_id, 108);
  EXPECT_NEAR(first.T_world_object.linear()(2, 2), 1.0, 1e-9);
  EXPECT_LT(second.T_world_object.linear()(2, 2), 0.5);
  EXPECT_EQ(upright.world().lights[0].position_world, lying.world().lights[0].position_world);
}

const Camera kMovedCamera{160, 120, 140.0, 140.0, 79.5, 59.5};

/// Returns a white post before nothing, 1 m away.
LitWorld post() {
  World world;
  const cv::Mat white(8, 8, CV_8UC3, cv::Scalar::all(255));
  world.items.push_back(
      {make_asset("post", box({0.1, 4.0, 0.02}, white), 0.0F), Eigen::Isometry3d::Identity(), 1, true});
  return light_world(world);
}

/// The camera looks along the world's z axis and moves along its x axis.
SceneMotion sideways(double metres_per_s) {
  return [=](World&, double seconds) {
    return Eigen::Isometry3d(Eigen::Translation3d(-metres_per_s * seconds, 0.0, 1.01));
  };
}

double middle_of_row(const cv::Mat& ids, int y) {
  const cv::Moments moments = cv::moments(ids.row(y) != 0, true);
  return moments.m10 / moments.m00;
}

int partly_lit(const ShadedView& view, int y) {
  double brightest = 0.0;
  cv::minMaxLoc(view.radiance.row(y).reshape(1), nullptr, &brightest);
  int count = 0;
  for (int x = 0; x < kMovedCamera.width; ++x) {
    const float level = view.radiance.at<cv::Vec3f>(y, x)[1];
    if (level > 0.02 * brightest && level < 0.98 * brightest) ++count;
  }
  return count;
}

TEST(MovingCamera, WhatStandsStillIsAsAnImageOfOneMoment) {
  const LitWorld world = post();
  World moved = world.world;
  const ShadedView exposed = expose(world, kMovedCamera, sideways(0.0), 0.3, {0.01, 0.02});
  const ShadedView moment = shade_view(world, kMovedCamera, sideways(0.0)(moved, 0.0));
  EXPECT_EQ(cv::norm(exposed.radiance, moment.radiance, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::countNonZero(exposed.geometry.id != moment.geometry.id), 0);
  EXPECT_EQ(cv::countNonZero(exposed.geometry.triangle != moment.geometry.triangle), 0);
}

TEST(MovingCamera, RowsAreExposedOneAfterTheOther) {
  const ShadedView view = expose(post(), kMovedCamera, sideways(1.0), 0.0, {0.0, 0.1});
  // The motion is 0.1 s of 1 m/s seen from 1 m at 140 px: 14 px from the first row to the last, none in the middle.
  EXPECT_NEAR(middle_of_row(view.geometry.id, 59), 79.5, 0.8);
  EXPECT_NEAR(middle_of_row(view.geometry.id, 2) - middle_of_row(view.geometry.id, 117), 14.0, 1.5);
}

TEST(MovingCamera, EdgesAreSmearedByTheWayOfAnExposure) {
  const ShadedView sharp = expose(post(), kMovedCamera, sideways(1.0), 0.0, {0.0, 0.0});
  const ShadedView blurred = expose(post(), kMovedCamera, sideways(1.0), 0.0, {0.05, 0.0});
  EXPECT_EQ(partly_lit(sharp, 60), 0);
  // The motion is 7 px: half of both edges belong to the post; nothing is behind it that could be smeared.
  EXPECT_NEAR(partly_lit(blurred, 60), 7, 2);
  EXPECT_EQ(cv::countNonZero(sharp.geometry.id != blurred.geometry.id), 0);
}

}  // namespace

}  // namespace houghstream::world
