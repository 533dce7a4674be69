#include "pose/seen/handle_observation.hpp"

#include <gtest/gtest.h>

#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

constexpr double kBeside_deg = 0.0;      // azimuth at which the handle is to the right of the mug
constexpr double kBehind_deg = 90.0;     // azimuth at which the mug hides it
constexpr double kSearchStep_deg = 8.0;  // a step of the search
const DepthTolerance kHandleTolerance{0.008, {}};

Mesh painted_mug() {
  Mesh mesh = mug();
  mesh.colours.assign(mesh.vertices.size(), cv::Vec3b(110, 140, 160));  // of the first item of noisy_frame()
  return mesh;
}

Eigen::Isometry3d mug_at(double azimuth_deg) {
  return standing(azimuth_deg, 30.0, 0.8);
}

double degrees_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() * 180.0 / M_PI;
}

/// A mug on a grey table, with or without a grey slab where its handle could be.
struct MugScene {
  explicit MugScene(double azimuth_deg, const Mesh& taught = painted_mug(), bool with_slab = false)
      : truth(mug_at(azimuth_deg)), model(make_object_model("mug", taught, {})) {
    std::vector<RenderItem> items = {{&mesh, truth, 1}, {&ground, truth * Eigen::Translation3d(0, 0, -0.05), 2}};
    if (with_slab) items.push_back({&slab, mug_at(kBeside_deg), 3});
    frame = noisy_frame(items, 3);
  }
  static Mesh make_slab() {
    Mesh box;
    add_box(box, {0.043F, -0.006F, -0.034F}, {0.075F, 0.006F, 0.034F});
    return box;
  }
  ObjectObservation observe() const {
    Detection detection;
    detection.box_px = cv::Rect2f(240.0F, 150.0F, 200.0F, 200.0F);
    detection.centre_camera = truth.translation().cast<float>();
    return observe_object(make_frame_context(frame, {}, {}), detection, model, {});
  }
  std::optional<Eigen::Isometry3d> turn_from(double azimuth_deg) const {
    const ObjectObservation observation = observe();
    return HandleObserver(observation, mug_at(azimuth_deg), kHandleTolerance).find_turn();
  }
  HandleObservation handle_at(double azimuth_deg) const {
    const ObjectObservation observation = observe();
    return HandleObserver(observation, truth, kHandleTolerance).observe_at(mug_at(azimuth_deg));
  }

  Mesh mesh = mug();
  Mesh ground = table();
  Mesh slab = make_slab();
  Eigen::Isometry3d truth;
  ObjectModel model;
  RgbdFrame frame;
};

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
