#include "tools/render/world/takes/moving_camera.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tools/render/world/objects/mesh_parts.hpp"

namespace houghstream::world {
namespace {

const Camera kCamera{160, 120, 140.0, 140.0, 79.5, 59.5};

/// A white post before nothing, 1 m away.
LitWorld post() {
  World world;
  const cv::Mat white(8, 8, CV_8UC3, cv::Scalar::all(255));
  world.items.push_back(
      {make_asset("post", box({0.1, 4.0, 0.02}, white), 0.0F), Eigen::Isometry3d::Identity(), 1, true});
  return light_world(world);
}

/// The camera looks along the world's z axis and moves along its x axis.
Motion sideways(double metres_per_s) {
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
  for (int x = 0; x < kCamera.width; ++x) {
    const float level = view.radiance.at<cv::Vec3f>(y, x)[1];
    if (level > 0.02 * brightest && level < 0.98 * brightest) ++count;
  }
  return count;
}

TEST(MovingCamera, WhatStandsStillIsAsAPictureOfOneMoment) {
  const LitWorld world = post();
  World moved = world.world;
  const ShadedView exposed = expose(world, kCamera, sideways(0.0), 0.3, {0.01, 0.02});
  const ShadedView moment = shade_view(world, kCamera, sideways(0.0)(moved, 0.0));
  EXPECT_EQ(cv::norm(exposed.radiance, moment.radiance, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::countNonZero(exposed.geometry.id != moment.geometry.id), 0);
  EXPECT_EQ(cv::countNonZero(exposed.geometry.triangle != moment.geometry.triangle), 0);
}

TEST(MovingCamera, RowsAreExposedOneAfterTheOther) {
  const ShadedView view = expose(post(), kCamera, sideways(1.0), 0.0, {0.0, 0.1});
  // 0.1 s of 1 m/s seen from 1 m at 140 px: 14 px from the first row to the last, none in the middle.
  EXPECT_NEAR(middle_of_row(view.geometry.id, 59), 79.5, 0.8);
  EXPECT_NEAR(middle_of_row(view.geometry.id, 2) - middle_of_row(view.geometry.id, 117), 14.0, 1.5);
}

TEST(MovingCamera, EdgesAreSmearedByTheWayOfAnExposure) {
  const ShadedView sharp = expose(post(), kCamera, sideways(1.0), 0.0, {0.0, 0.0});
  const ShadedView blurred = expose(post(), kCamera, sideways(1.0), 0.0, {0.05, 0.0});
  EXPECT_EQ(partly_lit(sharp, 60), 0);
  // 7 px of way: the post's own half of both its edges; nothing is behind it that could be smeared.
  EXPECT_NEAR(partly_lit(blurred, 60), 7, 2);
  EXPECT_EQ(cv::countNonZero(sharp.geometry.id != blurred.geometry.id), 0);
}

}  // namespace
}  // namespace houghstream::world
