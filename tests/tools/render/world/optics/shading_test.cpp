#include "tools/render/world/optics/shading.hpp"

#include <gtest/gtest.h>

#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

const Camera kCamera{160, 120, 150.0, 150.0, 79.5, 59.5};

// A white floor, a lamp above it to the right, and a plate between the two.
World floor_under_a_plate() {
  World world;
  const cv::Mat white(32, 32, CV_8UC3, cv::Scalar::all(255));
  Placed floor{make_thing("floor", box({2, 2, 0.1}, white), 0.0F), Eigen::Isometry3d::Identity(), 0, true};
  floor.T_world_object.translate(Eigen::Vector3d(0, 0, -0.05));
  Placed plate{make_thing("plate", box({0.2, 0.2, 0.01}, white), 0.0F), Eigen::Isometry3d::Identity(), 0, true};
  plate.T_world_object.translate(Eigen::Vector3d(0.3, 0, 0.3));
  world.items = {floor, plate};
  world.lights = {Light{{2.0, 0.0, 2.0}, Eigen::Vector3f::Ones(), 0.01, true}};
  world.ambient_bgr.setConstant(0.1F);
  return world;
}

TEST(Shading, APlateCastsItsShadowAwayFromTheLamp) {
  World world = floor_under_a_plate();
  const Eigen::Isometry3d T_camera_world = look_at({0, 0, 2}, {0, 0, 0});
  const Eigen::Vector2d shadow_px = kCamera.project(T_camera_world * Eigen::Vector3d(0.0, 0.0, 0.0));
  const Eigen::Vector2d lit_px = kCamera.project(T_camera_world * Eigen::Vector3d(-0.4, 0.0, 0.0));
  const auto brightness = [](const ShadedView& view, const Eigen::Vector2d& pixel) {
    return view.radiance.at<cv::Vec3f>(static_cast<int>(pixel.y()), static_cast<int>(pixel.x()))[1];
  };
  const ShadedView view = shade_view(light_world(world), kCamera, T_camera_world);
  EXPECT_NEAR(brightness(view, shadow_px), 0.1, 0.01);  // ambient light only
  EXPECT_GT(brightness(view, lit_px), 0.5);
  world.lights[0].casts_shadow = false;
  EXPECT_GT(brightness(shade_view(light_world(world), kCamera, T_camera_world), shadow_px), 0.5);
}

TEST(Shading, TextureIsWhereItBelongs) {
  World world;
  cv::Mat halves(64, 64, CV_8UC3, cv::Scalar(255, 0, 0));
  halves.colRange(32, 64).setTo(cv::Scalar(0, 0, 255));
  world.items = {{make_thing("sign", box({1, 0.1, 1}, halves), 0.0F), Eigen::Isometry3d::Identity(), 0, true}};
  const ShadedView view = shade_view(light_world(world), kCamera, look_at({0, -2, 0}, {0, 0, 0}));
  const cv::Vec3f left = view.radiance.at<cv::Vec3f>(60, 60);
  const cv::Vec3f right = view.radiance.at<cv::Vec3f>(60, 100);
  EXPECT_GT(left[0], 10 * left[2]);
  EXPECT_GT(right[2], 10 * right[0]);
  EXPECT_NEAR(view.cos_incidence.at<float>(60, 80), 1.0F, 0.01F);
}

}  // namespace
}  // namespace houghstream::world
