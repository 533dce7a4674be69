#include "pose/following/texture_modality.hpp"

#include <gtest/gtest.h>

#include "tests/pose/following/modality_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

/// Renders the can with waves of brightness on its surface that turn with it.
RgbdFrame painted_frame(const ModalityScene& scene, const Eigen::Isometry3d& pose, double brighter) {
  RgbdFrame frame = noisy_frame({{&scene.object, pose, 1}}, 3);
  const RenderedGeometry rendered = render_geometry({{&scene.object, pose, 1}}, kCamera);
  const Eigen::Isometry3d back = pose.inverse();
  for (int y = 0; y < frame.colour.rows; ++y) {
    for (int x = 0; x < frame.colour.cols; ++x) {
      const float z = rendered.depth.at<float>(y, x);
      if (std::isnan(z)) continue;
      const Eigen::Vector3d point = back * kCamera.backproject(x, y, z);
      const double tone = 110.0 + brighter + 50.0 * std::sin(7.0 * std::atan2(point.y(), point.x())) +
                          25.0 * std::sin(150.0 * point.z());
      frame.colour.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(tone));
    }
  }
  return frame;
}

const cv::Rect kAbout(220, 100, 260, 280);

TextureKeyframe keyframe_of(const ModalityScene& scene) {
  const RgbdFrame frame = painted_frame(scene, scene.truth, 0.0);
  return make_texture_keyframe({frame, scene.model, {}}, make_brightness(frame, kAbout), scene.truth, {});
}

TEST(TextureModality, ARoundThingsTurnIsSeenByItsTexture) {
  const ModalityScene& scene = can_scene();
  const TextureKeyframe keyframe = keyframe_of(scene);
  ASSERT_GE(keyframe.points.size(), 100U);
  Eigen::Isometry3d truth = scene.truth;
  truth.rotate(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()));
  const RgbdFrame frame = painted_frame(scene, truth, 15.0);  // the light has changed
  const BrightnessImage image = make_brightness(frame, kAbout);
  Eigen::Isometry3d pose = scene.truth;
  for (int i = 0; i < 6; ++i) {
    MotionEquations equations = texture_equations({frame, scene.model, {}}, image, keyframe, pose, i < 3 ? 1 : 0, {});
    equations.hessian.diagonal().array() += 1e3;
    move_by_step(equations.hessian.selfadjointView<Eigen::Lower>().ldlt().solve(equations.gradient), scene.model, pose);
  }
  const Eigen::AngleAxisd left(pose.linear().transpose() * truth.linear());
  EXPECT_LT(std::abs(left.angle()), 0.01);
}

TEST(TextureModality, APlainThingHasNoPoints) {
  const ModalityScene& scene = can_scene();
  RgbdFrame frame = painted_frame(scene, scene.truth, 0.0);
  frame.colour.setTo(cv::Scalar::all(90));
  EXPECT_TRUE(
      make_texture_keyframe({frame, scene.model, {}}, make_brightness(frame, kAbout), scene.truth, {}).points.empty());
}

TEST(TextureModality, WhatIsCoveredSaysNothing) {
  const ModalityScene& scene = can_scene();
  RgbdFrame frame = painted_frame(scene, scene.truth, 0.0);
  frame.depth = 0.4F;
  frame.colour.setTo(cv::Scalar::all(20));
  const MotionEquations equations = texture_equations({frame, scene.model, {}}, make_brightness(frame, kAbout),
                                                      keyframe_of(scene), scene.truth, 0, {});
  EXPECT_TRUE(equations.hessian.isZero(0.0));
}

}  // namespace
}  // namespace houghstream
