#include "pose/seen/foreground_search.hpp"

#include <gtest/gtest.h>

#include "tests/pose/flat_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

/// Returns the mean evidence of the model's points at a pose.
float mean_at(const FlatScene& scene, const SurfaceForeground& foreground, const Eigen::Isometry3d& pose) {
  return mean_evidence(foreground, project_view(scene.frame, scene.model, pose, 200));
}

TEST(SurfaceForeground, IsWhatLiesOnTheTableInAnotherColour) {
  const FlatScene scene(20.0);
  const ObjectObservation observation = scene.observe();
  ASSERT_TRUE(observation.foreground.has_value());
  const SurfaceForeground& foreground = *observation.foreground;
  EXPECT_GT(mean_at(scene, foreground, scene.truth), 0.7F);
  EXPECT_LT(mean_at(scene, foreground, scene.truth * Eigen::Translation3d(0.0, 0.035, 0.0)), -0.7F) << "beside it";
  const Eigen::Vector3d up = scene.truth.linear().col(2);
  EXPECT_GT(foreground.plane.normal().dot(up), 0.999);
  EXPECT_LT((foreground.centre - scene.truth.translation()).norm(), 0.015);
}

TEST(SurfaceForeground, WhatIsTallerIsNoPart) {
  const FlatScene scene(20.0, true);
  const ObjectObservation observation = scene.observe();
  ASSERT_TRUE(observation.foreground.has_value());
  const Eigen::Isometry3d on_the_box = scene.truth * Eigen::Translation3d(0.0, 0.09, 0.07);
  EXPECT_LT(mean_at(scene, *observation.foreground, on_the_box), 0.0F);
  EXPECT_GT(mean_at(scene, *observation.foreground, scene.truth), 0.6F);
}

TEST(SurfaceForeground, IsNoneWithoutAPlaneOrWithoutAnotherColour) {
  FlatScene grey(20.0);
  grey.frame.colour.setTo(cv::Scalar(90, 90, 90));
  EXPECT_FALSE(grey.observe().foreground.has_value());

  FlatScene rough(20.0);
  Random random(2);
  for (int y = 0; y < rough.frame.depth.rows; ++y) {
    for (int x = 0; x < rough.frame.depth.cols; ++x)
      rough.frame.depth.at<float>(y, x) += 0.1F * static_cast<float>(random.uniform());
  }
  EXPECT_FALSE(rough.observe().foreground.has_value());
}

}  // namespace
}  // namespace houghstream
