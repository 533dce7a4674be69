#include <gtest/gtest.h>

#include "tools/render/world/optics/shading.hpp"

namespace houghstream::world {
namespace {

/// Returns a plate of 0.4 m, half a metre above the floor, under a lamp.
World shaded_floor() {
  Mesh mesh;
  mesh.vertices = {{-0.2F, -0.2F, 0.5F}, {0.2F, -0.2F, 0.5F}, {0.2F, 0.2F, 0.5F}, {-0.2F, 0.2F, 0.5F}};
  mesh.normals.assign(4, Eigen::Vector3f::UnitZ());
  mesh.uvs = {{0.0F, 0.0F}, {1.0F, 0.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.texture = cv::Mat(4, 4, CV_8UC3, cv::Scalar::all(100));
  World world;
  PlacedAsset plate;
  plate.thing = make_asset("plate", mesh, 0.0F);
  world.items.push_back(plate);
  return world;
}

Light lamp() {
  Light light;
  light.position_world = {0.0, 0.001, 3.0};  // not straight above, where the image has no upright
  return light;
}

/// Returns the shadow at a point of the world.
float light_at(const World& world, const Light& light, const Eigen::Vector3f& point_world) {
  const ShadowMap map = make_shadow_map(world, light);
  return ShadowLookup(map, Eigen::Isometry3d::Identity(), light.penumbra_m).lit(point_world, 0.3F);
}

TEST(ShadowMap, WhatLiesBehindAThingIsInItsShadow) {
  const World world = shaded_floor();
  EXPECT_EQ(light_at(world, lamp(), {0.0F, 0.0F, 0.0F}), 0.0F);
  EXPECT_EQ(light_at(world, lamp(), {0.6F, 0.0F, 0.0F}), 1.0F) << "beside it";
  EXPECT_EQ(light_at(world, lamp(), {0.0F, 0.0F, 0.8F}), 1.0F) << "above it";
  EXPECT_EQ(light_at(world, lamp(), {0.0F, 0.0F, 0.5F}), 1.0F) << "the thing does not shade itself";
}

TEST(ShadowMap, TheShadowsEdgeFades) {
  // The lamp throws the plate's edge from 0.2 m to 0.2 * 3 / 2.5 m.
  const float edge = light_at(shaded_floor(), lamp(), {0.24F, 0.0F, 0.0F});
  EXPECT_GT(edge, 0.0F);
  EXPECT_LT(edge, 1.0F);
}

TEST(ShadowMap, SomeLampsAndThingsCastNone) {
  World world = shaded_floor();
  Light light = lamp();
  light.casts_shadow = false;
  EXPECT_EQ(light_at(world, light, Eigen::Vector3f::Zero()), 1.0F);
  world.items[0].casts_shadow = false;
  EXPECT_EQ(light_at(world, lamp(), Eigen::Vector3f::Zero()), 1.0F);
}

TEST(ShadowMap, BeyondTheFocusThereIsLight) {
  EXPECT_EQ(light_at(shaded_floor(), lamp(), {5.0F, 0.0F, 0.0F}), 1.0F);
}

}  // namespace
}  // namespace houghstream::world
