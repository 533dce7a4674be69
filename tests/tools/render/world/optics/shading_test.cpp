#include "tools/render/world/optics/shading.hpp"

#include <gtest/gtest.h>

#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

const Camera kShadingCamera{160, 120, 150.0, 150.0, 79.5, 59.5};

// Returns a white floor, a lamp above it to the right, and a plate between the two.
World floor_under_a_plate() {
  World world;
  const cv::Mat white(32, 32, CV_8UC3, cv::Scalar::all(255));
  PlacedAsset floor{make_asset("floor", box({2, 2, 0.1}, white), 0.0F), Eigen::Isometry3d::Identity(), 0, true};
  floor.T_world_object.translate(Eigen::Vector3d(0, 0, -0.05));
  PlacedAsset plate{make_asset("plate", box({0.2, 0.2, 0.01}, white), 0.0F), Eigen::Isometry3d::Identity(), 0, true};
  plate.T_world_object.translate(Eigen::Vector3d(0.3, 0, 0.3));
  world.items = {floor, plate};
  world.lights = {Light{{2.0, 0.0, 2.0}, Eigen::Vector3f::Ones(), 0.01, true}};
  world.ambient_bgr.setConstant(0.1F);
  return world;
}

TEST(Shading, APlateCastsItsShadowAwayFromTheLamp) {
  World world = floor_under_a_plate();
  const Eigen::Isometry3d T_camera_world = look_at({0, 0, 2}, {0, 0, 0});
  const Eigen::Vector2d shadow_px = kShadingCamera.project(T_camera_world * Eigen::Vector3d(0.0, 0.0, 0.0));
  const Eigen::Vector2d lit_px = kShadingCamera.project(T_camera_world * Eigen::Vector3d(-0.4, 0.0, 0.0));
  const auto brightness = [](const ShadedView& view, const Eigen::Vector2d& pixel) {
    return view.radiance.at<cv::Vec3f>(static_cast<int>(pixel.y()), static_cast<int>(pixel.x()))[1];
  };
  const ShadedView view = shade_view(light_world(world), kShadingCamera, T_camera_world);
  EXPECT_NEAR(brightness(view, shadow_px), 0.1, 0.01);  // ambient light only
  EXPECT_GT(brightness(view, lit_px), 0.5);
  world.lights[0].casts_shadow = false;
  EXPECT_GT(brightness(shade_view(light_world(world), kShadingCamera, T_camera_world), shadow_px), 0.5);
}

TEST(Shading, TextureIsWhereItBelongs) {
  World world;
  cv::Mat halves(64, 64, CV_8UC3, cv::Scalar(255, 0, 0));
  halves.colRange(32, 64).setTo(cv::Scalar(0, 0, 255));
  world.items = {{make_asset("sign", box({1, 0.1, 1}, halves), 0.0F), Eigen::Isometry3d::Identity(), 0, true}};
  const ShadedView view = shade_view(light_world(world), kShadingCamera, look_at({0, -2, 0}, {0, 0, 0}));
  const cv::Vec3f left = view.radiance.at<cv::Vec3f>(60, 60);
  const cv::Vec3f right = view.radiance.at<cv::Vec3f>(60, 100);
  EXPECT_GT(left[0], 10 * left[2]);
  EXPECT_GT(right[2], 10 * right[0]);
  EXPECT_NEAR(view.cos_incidence.at<float>(60, 80), 1.0F, 0.01F);
}

ShadedView seen_from_a_corner(const AssetPtr& thing) {
  World world;
  world.items = {{thing, Eigen::Isometry3d::Identity(), 0, true}};
  world.lights = {Light{{1.0, -2.0, 2.0}, Eigen::Vector3f::Ones(), 0.01, true}};
  world.ambient_bgr.setConstant(0.1F);
  return shade_view(light_world(world), kShadingCamera, look_at({0.5, -1, 0.8}, {0, 0, 0}));
}

TEST(Shading, ColoursOfVerticesShadeAsATextureOfTheSameColour) {
  const cv::Vec3b colour(30, 120, 210);
  const Mesh textured = box({0.4, 0.3, 0.2}, cv::Mat(16, 16, CV_8UC3, cv::Scalar(colour)));
  Mesh coloured = textured;
  coloured.texture.release();
  coloured.uvs.clear();
  coloured.colours.assign(coloured.vertices.size(), colour);
  const ShadedView by_texture = seen_from_a_corner(make_asset("box", textured, 0.3F));
  const ShadedView by_vertex = seen_from_a_corner(make_asset("box", coloured, 0.3F));
  EXPECT_GT(cv::countNonZero(by_texture.geometry.id), 1000);
  double brightest = 0.0;
  cv::minMaxLoc(by_texture.radiance.reshape(1), nullptr, &brightest);
  EXPECT_GT(brightest, 0.1);
  EXPECT_LT(cv::norm(by_texture.radiance, by_vertex.radiance, cv::NORM_INF), 1e-5);
  EXPECT_LT(cv::norm(by_texture.reflectance, by_vertex.reflectance, cv::NORM_INF), 1e-5);
  EXPECT_EQ(cv::norm(by_texture.specular, by_vertex.specular, cv::NORM_INF), 0.0);
}

TEST(Shading, ColoursOfVerticesBlendBetweenThem) {
  Mesh mesh = box({0.4, 0.3, 0.2}, cv::Mat(16, 16, CV_8UC3, cv::Scalar::all(0)));
  mesh.texture.release();
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    mesh.colours.push_back(vertex.x() < 0.0F ? cv::Vec3b(255, 0, 0) : cv::Vec3b(0, 0, 255));
  World world;
  world.items = {{make_asset("box", mesh, 0.0F), Eigen::Isometry3d::Identity(), 0, true}};
  const ShadedView view = shade_view(light_world(world), kShadingCamera, look_at({0, -1, 0}, {0, 0, 0}));
  const auto at = [&](double x) {
    const Eigen::Vector2d px = kShadingCamera.project(look_at({0, -1, 0}, {0, 0, 0}) * Eigen::Vector3d(x, -0.15, 0.0));
    return view.radiance.at<cv::Vec3f>(static_cast<int>(px.y()), static_cast<int>(px.x()));
  };
  EXPECT_GT(at(-0.19)[0], 10 * at(-0.19)[2]);
  EXPECT_GT(at(0.19)[2], 10 * at(0.19)[0]);
  EXPECT_NEAR(at(0.0)[0], at(0.0)[2], 0.05F * at(0.0)[0]);
}

}  // namespace
}  // namespace houghstream::world
