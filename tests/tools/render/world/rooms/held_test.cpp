#include "tools/render/world/rooms/held.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/tools/render/world/closed_surface.hpp"
#include "tests/tools/render/world/scene_checks.hpp"
#include "tools/render/world/objects/objects.hpp"

namespace houghstream::world {
namespace {

HeldPlace place() {
  HeldPlace place;
  place.over = {0.2, -0.1};
  place.arm_azimuth_rad = 0.3;
  place.views = {look_at({-0.5, -1.1, 0.8}, {0, 0, 0.1}), look_at({0.5, -1.1, 0.7}, {0, 0, 0.1})};
  return place;
}

TEST(Held, AnyAttitudeIsUniformOverAllRotations) {
  constexpr int kCount = 4000;
  Random random(5);
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d mean_sq = Eigen::Matrix3d::Zero();
  int small_rotations = 0;  // the share of rotations by less than a is (a - sin a) / pi
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Matrix3d R = any_attitude(random);
    EXPECT_NEAR(R.determinant(), 1.0, 1e-9);
    mean += R / kCount;
    mean_sq += R.cwiseAbs2() / kCount;
    small_rotations += Eigen::AngleAxisd(R).angle() < M_PI / 2 ? 1 : 0;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 0.04);
  EXPECT_LT((mean_sq.array() - 1.0 / 3.0).abs().maxCoeff(), 0.03);
  EXPECT_NEAR(static_cast<double>(small_rotations) / kCount, (M_PI / 2 - 1.0) / M_PI, 0.03);
}

TEST(Held, ThingsFloatBetween5And30CentimetresAboveTheirPlaceAndTheHandDoesNotTouchTheTable) {
  for (int id = 1; id <= kClassCount; ++id) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      Random random(seed);
      const AssetGroup group = hold(make_taught_object(id).thing, id, place(), random);
      ASSERT_EQ(group.size(), 2U);
      EXPECT_EQ(group[0].thing->name, "hand");
      EXPECT_EQ(group[0].object_id, 0);
      EXPECT_EQ(group[1].object_id, id);
      EXPECT_GE(lowest_point(group[1]), kMinHeldM - 1e-6);
      EXPECT_LE(lowest_point(group[1]), kMaxHeldM + 1e-6);
      EXPECT_GT(lowest_point(group[0]), 0.0);
      EXPECT_NEAR((group[1].T_world_object.translation().head<2>() - place().over).norm(), 0.0, 1e-9);
    }
  }
}

TEST(Held, TheArmComesFromItsSideAndReachesFar) {
  Random random(3);
  const AssetGroup group = hold(make_taught_object(4).thing, 4, place(), random);
  double farthest = 0.0;
  for (const Eigen::Vector3f& vertex : group[0].thing->mesh.vertices) {
    farthest = std::max(farthest, (group[0].T_world_object * vertex.cast<double>()).x());
  }
  EXPECT_GT(farthest, place().over.x() + 0.3);
}

TEST(Held, HandsHaveSurfacesThatFaceOutwards) {
  Random random(3);
  const AssetGroup group = hold(make_taught_object(3).thing, 3, place(), random);
  EXPECT_TRUE(is_closed(group[0].thing->mesh));
  EXPECT_GT(signed_volume(group[0].thing->mesh), 0.0);
  EXPECT_GT(agreeing_normals(group[0].thing->mesh), 0.95);
}

}  // namespace
}  // namespace houghstream::world
