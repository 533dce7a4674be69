#include "pose/verification/shared_surface.hpp"

#include <gtest/gtest.h>

#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

constexpr double kDeeper_m = 0.02;

/// A model with its pose in a frame.
struct Placed {
  ObjectModel model;
  Eigen::Isometry3d T_camera_object;

  Placed(Mesh mesh, const Eigen::Isometry3d& T) : model(make_object_model("it", std::move(mesh), {})) {
    T_camera_object = T;
  }
  RenderItem item(int id) const { return {&model.mesh, T_camera_object, id}; }
};

float shared_by(const std::vector<RenderItem>& scene, const Placed& a, const Placed& b) {
  const RgbdFrame frame = noisy_frame(scene, 3);
  const DepthTolerance tolerance{kDepthTolerance_m, {}};
  const float one_way = shared_surface(frame, {a.model, a.T_camera_object}, {b.model, b.T_camera_object}, tolerance);
  EXPECT_EQ(one_way, shared_surface(frame, {b.model, b.T_camera_object}, {a.model, a.T_camera_object}, tolerance));
  return one_way;
}

Mesh block(float half_x, float half_y, float half_z) {
  Mesh mesh;
  add_box(mesh, {-half_x, -half_y, -half_z}, {half_x, half_y, half_z});
  return mesh;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& T, double x, double y, double z) {
  return T * Eigen::Translation3d(x, y, z);
}

TEST(SharedSurface, ABoxAndADeeperOneWithTheSameFrontAreOne) {
  const Placed box(cereal_box(), standing(10.0, 20.0, 0.8));
  const Placed deeper(block(0.09F, 0.05F, 0.13F), moved(box.T_camera_object, 0.0, kDeeper_m, 0.0));
  EXPECT_GT(shared_by({box.item(1)}, box, deeper), 0.75F);
}

TEST(SharedSurface, AFewMillimetresOfAPosesErrorDoNotMakeTwoOfOne) {
  const Placed box(cereal_box(), standing(10.0, 20.0, 0.8));
  const Placed other(block(0.085F, 0.03F, 0.12F), moved(box.T_camera_object, 0.002, 0.0015, 0.0));
  EXPECT_GT(shared_by({box.item(1)}, box, other), 0.75F);
}

TEST(SharedSurface, WhatStandsInAMugIsNotTheMug) {
  const Placed cup(mug(), standing(0.0, 60.0, 0.6));
  const Placed content(block(0.015F, 0.015F, 0.03F), moved(cup.T_camera_object, 0.0, 0.0, -0.01));
  EXPECT_LT(shared_by({cup.item(1), content.item(2)}, cup, content), 0.1F);
}

TEST(SharedSurface, NeighboursThatTouchShareNothing) {
  const Placed box(cereal_box(), standing(10.0, 30.0, 0.8));
  const Placed beside(block(0.05F, 0.03F, 0.05F), moved(box.T_camera_object, 0.14, 0.0, -0.08));
  const Placed on_top(block(0.05F, 0.03F, 0.01F), moved(box.T_camera_object, 0.0, 0.0, 0.14));
  EXPECT_LT(shared_by({box.item(1), beside.item(2)}, box, beside), 0.05F);
  EXPECT_LT(shared_by({box.item(1), on_top.item(2)}, box, on_top), 0.05F);
}

TEST(SharedSurface, ACardThatLiesFlatOnABoxIsNotTheBox) {
  const Placed box(block(0.09F, 0.13F, 0.03F), standing(10.0, 60.0, 0.6));
  const Placed card(block(0.04F, 0.06F, 0.004F), moved(box.T_camera_object, 0.0, 0.0, 0.034));
  EXPECT_LT(shared_by({box.item(1), card.item(2)}, box, card), 0.1F);
}

TEST(SharedSurface, WhatIsFarApartOrWithoutDepthSharesNothing) {
  const Placed box(cereal_box(), standing(10.0, 20.0, 0.8));
  const Placed far(cereal_box(), moved(box.T_camera_object, 0.5, 0.0, 0.0));
  EXPECT_EQ(shared_by({box.item(1)}, box, far), 0.0F);
  EXPECT_EQ(shared_by({}, box, box), 0.0F);
}

TEST(ExplainedSurface, IsThatOfTheModelsAndNotOfWhatLiesOnThem) {
  const Placed box(cereal_box(), standing(10.0, 20.0, 0.8));
  const Placed inside(block(0.04F, 0.02F, 0.04F), moved(box.T_camera_object, 0.0, -0.01, 0.0));  // in its front
  const Placed before(block(0.04F, 0.02F, 0.04F), moved(box.T_camera_object, 0.0, -0.05, 0.0));
  const RgbdFrame frame = noisy_frame({box.item(1), before.item(2)}, 3);
  ExplainedSurface explained;
  const auto fraction = [&](const Placed& placed, const RgbdFrame& in) {
    return explained.fraction_of(in, {placed.model, placed.T_camera_object}, {kDepthTolerance_m, {}});
  };
  EXPECT_TRUE(explained.is_empty());
  EXPECT_EQ(fraction(box, frame), 0.0F);
  explained.add({box.model, box.T_camera_object});
  EXPECT_FALSE(explained.is_empty());
  EXPECT_GT(fraction(box, frame), 0.95F);
  EXPECT_LT(fraction(before, frame), 0.1F) << "stands before it";
  const RgbdFrame alone = noisy_frame({box.item(1)}, 3);
  EXPECT_GT(fraction(inside, alone), 0.6F) << "its front is the box's";
}

}  // namespace
}  // namespace houghstream
