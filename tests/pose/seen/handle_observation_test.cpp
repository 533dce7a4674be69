#include "pose/seen/handle_observation.hpp"

#include <gtest/gtest.h>

#include "tests/pose/mug_scene.hpp"
#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

constexpr double kSearchStep_deg = 8.0;  // a step of the search

TEST(HandleObservation, AMugIsTurnedToWhereItsHandleIs) {
  const MugScene scene(kBeside_deg);
  for (const double start_deg : {kBehind_deg, 180.0, -60.0}) {
    const std::optional<Eigen::Isometry3d> turned = scene.turn_from(start_deg);
    ASSERT_TRUE(turned.has_value()) << start_deg;
    EXPECT_LT(degrees_between(*turned, scene.truth), kSearchStep_deg) << start_deg;
  }
  EXPECT_FALSE(scene.turn_from(kBeside_deg).has_value()) << "it is there";
}

TEST(HandleObservation, DepthAloneFindsTheHandleOfAModelWithoutColours) {
  const MugScene scene(kBeside_deg, mug());
  const std::optional<Eigen::Isometry3d> turned = scene.turn_from(kBehind_deg);
  ASSERT_TRUE(turned.has_value());
  EXPECT_LT(degrees_between(*turned, scene.truth), kSearchStep_deg);
}

TEST(HandleObservation, AHandleThatPointsAtTheCameraIsFoundThoughDepthBlursIt) {
  MugScene scene(kBefore_deg);
  const MugScene body(kBehind_deg);
  for (int y = 0; y < scene.frame.depth.rows; ++y) {
    for (int x = 1; x < scene.frame.depth.cols; x += 2)
      scene.frame.depth.at<float>(y, x) = body.frame.depth.at<float>(y, x);
  }
  EXPECT_TRUE(scene.handle_at(kBefore_deg).is_visible());
  const std::optional<Eigen::Isometry3d> turned = scene.turn_from(kBehind_deg);
  ASSERT_TRUE(turned.has_value());
  EXPECT_LT(degrees_between(*turned, scene.truth), kSearchStep_deg);
}

TEST(HandleObservation, AHiddenHandleIsSoughtNowhereElse) {
  const MugScene scene(kBehind_deg);
  EXPECT_FALSE(scene.turn_from(kBehind_deg).has_value());
  EXPECT_TRUE(scene.handle_at(kBehind_deg).can_be_occluded());
  EXPECT_FALSE(scene.handle_at(kBehind_deg).is_visible());
}

TEST(HandleObservation, WhereTheTableIsSeenThereIsNoHandle) {
  const MugScene scene(kBehind_deg);
  EXPECT_LT(scene.handle_at(kBeside_deg).support(), -0.5);
  const std::optional<Eigen::Isometry3d> turned = scene.turn_from(kBeside_deg);
  ASSERT_TRUE(turned.has_value());
  const ObjectObservation observation = scene.observe();
  EXPECT_TRUE(HandleObserver(observation, scene.truth, kHandleTolerance).observe_at(*turned).can_be_occluded());
}

TEST(HandleObservation, WhatTouchesTheMugInAnotherColourIsNoHandle) {
  const MugScene scene(kBehind_deg, painted_mug(), true);
  EXPECT_FALSE(scene.turn_from(kBehind_deg).has_value());
  EXPECT_FALSE(scene.handle_at(kBeside_deg).is_visible());
}

TEST(HandleObservation, ABoxHasNoHandle) {
  const RgbdFrame frame = coloured_frame(printed_box(), mug_at(0.0), 1);
  const ObjectModel model = make_object_model("box", printed_box(), {});
  const ObjectObservation observation{frame, model};
  const HandleObserver handle(observation, mug_at(0.0), kHandleTolerance);
  EXPECT_EQ(handle.observe_at(mug_at(0.0)).points, 0);
  EXPECT_EQ(handle.observe_at(mug_at(0.0)).support(), 0.0);
  EXPECT_FALSE(handle.find_turn().has_value());
}

}  // namespace
}  // namespace houghstream
