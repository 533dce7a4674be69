#include "pose/reconstruction/model/model_deviation.hpp"

#include <gtest/gtest.h>

#include "tests/pose/reconstruction/shown_scene.hpp"

namespace houghstream::reconstruction {
namespace {

TEST(SeenThrough, WhatIsNoPartOfTheObjectIsSeenThrough) {
  const test_scene::ShownScene scene;
  Take take;
  std::vector<MaskedKeyframe> views;
  for (int i = 0; i < 6; ++i) {
    Keyframe keyframe;
    keyframe.T_camera_world = test_scene::camera_at(1.0 * i, 0.7, 0.6);
    keyframe.frame =
        test_scene::photograph(test_scene::table_with(scene), keyframe.T_camera_world, scene.camera, i + 1);
    views.push_back({i, keyframe.T_camera_world, {}});
    take.keyframes.push_back(std::move(keyframe));
  }
  const Mesh box = test_scene::box_of(scene);
  EXPECT_LT(free_space_violation(box, take, views, 1), 0.002);
  Mesh with_finger = box;
  test_scene::add_side({0.5 * scene.box.x(), 0.0, 0.1}, {0.06, 0.0, 0.0}, {0.0, 0.02, 0.04}, with_finger);
  const double fraction = free_space_violation(with_finger, take, views, 1);
  EXPECT_GT(fraction, kMaxFreeSpaceViolation);
  EXPECT_LT(fraction, 0.1);
  EXPECT_EQ(free_space_violation(with_finger, take, views, 3), fraction);
}

TEST(SeenThrough, NothingIsSeenThroughBesideAPixelWithoutDepth) {
  const test_scene::ShownScene scene;
  const Mesh box = test_scene::box_of(scene);
  Take take;
  take.keyframes.resize(1);
  RgbdFrame& frame = take.keyframes[0].frame;
  frame.camera = scene.camera;
  frame.depth = cv::Mat(scene.camera.height, scene.camera.width, CV_32FC1, cv::Scalar(2.0));
  const std::vector<MaskedKeyframe> views = {{0, test_scene::camera_at(0.0, 0.7, 0.6), {}}};
  EXPECT_EQ(free_space_violation(box, take, views, 1), 1.0);
  for (int x = 0; x < frame.depth.cols; x += 3) frame.depth.col(x).setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(free_space_violation(box, take, views, 1), 0.0);
}

TEST(Disagreement, IsTheMedianDistanceOverTheViewsOfAllTakes) {
  const test_scene::ShownScene scene;
  const Mesh table = test_scene::table_with(scene);
  const Mesh box = test_scene::box_of(scene);
  Mesh larger;
  test_scene::add_box(scene.box + Eigen::Vector3d(0.01, 0.01, 0.005), 0.0, larger);  // 5 mm on every side
  std::vector<Take> takes(2);
  std::vector<std::vector<MaskedKeyframe>> views(2);
  for (int i = 0; i < 6; ++i) {
    Keyframe keyframe;
    keyframe.T_camera_world = test_scene::camera_at(1.0 * i, 0.7, 0.6);
    keyframe.frame = test_scene::photograph(table, keyframe.T_camera_world, scene.camera, i + 1);
    const auto of = static_cast<std::size_t>(i % 2);
    views[of].push_back(
        {i / 2, keyframe.T_camera_world, render_visible_mask(box, keyframe.frame, keyframe.T_camera_world)});
    takes[of].keyframes.push_back(std::move(keyframe));
  }
  const std::vector<ViewsOfTake> both = {{&takes[0], &views[0]}, {&takes[1], &views[1]}};
  EXPECT_LT(surface_deviation(box, both, 1), 1e-4);
  const double apart = surface_deviation(larger, both, 1);
  EXPECT_NEAR(apart, 0.005, 0.001);
  EXPECT_EQ(surface_deviation(larger, both, 3), apart);
  EXPECT_EQ(surface_deviation(box, {}, 1), 0.0);
}

}  // namespace
}  // namespace houghstream::reconstruction
