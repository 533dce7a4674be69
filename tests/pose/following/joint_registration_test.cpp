#include "pose/following/joint_registration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pipeline/geometry/renderer.hpp"
#include "pose/motion/twist.hpp"
#include "tests/pose/following/modality_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

JointResult registered(const ModalityScene& scene, const Eigen::Isometry3d& start, bool with_colours,
                       const JointSettings& settings = {}) {
  JointStart joint;
  joint.T_camera_object = start;
  if (with_colours) joint.appearance.colours = std::make_shared<const ColourStatistics>(scene.learnt());
  const ObjectObservation observation =
      observe_object({scene.frame, {}, {}}, detection_of("it", scene.object, scene.truth, 1), scene.model, {});
  return register_jointly(observation, joint, settings, {});
}

Eigen::Isometry3d beside(const ModalityScene& scene, const Eigen::Vector3d& shift, double angle_rad) {
  Eigen::Isometry3d start = scene.truth;
  start.rotate(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1.0, 1.0, 1.0).normalized()));
  start.pretranslate(shift);
  return start;
}

double angle_to_truth(const ModalityScene& scene, const Eigen::Isometry3d& pose) {
  return rotation_vector(pose.linear() * scene.truth.linear().transpose()).norm();
}

TEST(JointRegistration, DepthAndColoursTogetherFindThePose) {
  const ModalityScene& scene = box_scene();
  const JointResult result = registered(scene, beside(scene, {0.01, -0.008, 0.012}, 0.06), true);
  EXPECT_LT(scene.shift_of(result.registration.T_camera_object).norm(), 0.002);
  EXPECT_LT(angle_to_truth(scene, result.registration.T_camera_object), 0.015);
  EXPECT_GT(result.registration.inliers, 200);
  EXPECT_GT(result.edges, 60);
}

TEST(JointRegistration, DepthAloneFindsThePose) {
  const ModalityScene& scene = box_scene();
  const JointResult result = registered(scene, beside(scene, {0.01, -0.008, 0.012}, 0.06), false);
  EXPECT_LT(scene.shift_of(result.registration.T_camera_object).norm(), 0.003);
  EXPECT_EQ(result.edges, 0);
}

TEST(JointRegistration, ColoursAloneHoldThePoseAcrossTheLineOfSight) {
  ModalityScene scene = box_scene().copy();
  scene.frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  const JointResult result = registered(scene, beside(scene, {0.008, -0.006, 0.0}, 0.02), true);
  EXPECT_LT(scene.shift_of(result.registration.T_camera_object).head<2>().norm(), 0.0025);
  EXPECT_EQ(result.registration.inliers, 0);
  const Matrix6d& alone = result.information;
  const Matrix6d both = registered(box_scene(), scene.truth, true).information;
  EXPECT_LT(alone(5, 5), 0.5 * both(5, 5)) << "how far it is, is less sure";
  EXPECT_GT(alone(3, 3), 0.03 * both(3, 3));
}

TEST(JointRegistration, DepthThatIsOlderSaysNothingAlongTheMotion) {
  constexpr double kShift = 0.006;  // to the right since depth was measured
  const ModalityScene& scene = box_scene();
  const ModalityScene before(cereal_box(), -0.13, Eigen::Translation3d(-kShift, 0.0, 0.0) * scene.truth);
  ModalityScene mixed = scene.copy();
  mixed.frame.depth = before.frame.depth;
  JointStart joint;
  joint.T_camera_object = mixed.truth;
  joint.appearance.colours = std::make_shared<const ColourStatistics>(scene.learnt());
  const ObjectObservation observation =
      observe_object({mixed.frame, {}, {}}, detection_of("it", mixed.object, mixed.truth, 1), mixed.model, {});
  const auto error_m = [&] {
    return mixed.shift_of(register_jointly(observation, joint, {}, {}).registration.T_camera_object).norm();
  };
  EXPECT_GT(error_m(), 0.6 * kShift) << "depth is surer";
  joint.depth_lag.shift_m = {2.0 * kShift, 0.0, 0.0};
  EXPECT_LT(error_m(), 0.3 * kShift);
}

// A hand lies within the distance of pairs, as a part of the object would that stands out; its colours are not the
// object's.
TEST(JointRegistration, WhatGripsTheObjectDoesNotPullItsPose) {
  constexpr float kThickness_m = 0.012F;
  ModalityScene scene = box_scene().copy();
  const ColourStatistics colours = scene.learnt();
  const cv::Vec3b beside = scene.frame.colour.at<cv::Vec3b>(5, 5);
  ASSERT_LT(colours.foreground(beside), 0.1F);
  const RenderedRegion rendered = render_depth_region(scene.object, scene.truth, scene.frame.camera);
  const cv::Rect part = rendered.region_px;
  const cv::Rect gripped(part.x, part.y + part.height / 2, part.width, part.height / 2);
  for (int y = gripped.y; y < gripped.br().y; ++y) {
    for (int x = gripped.x; x < gripped.br().x; ++x) {
      if (std::isnan(rendered.depth_at({x, y}))) continue;
      scene.frame.depth.at<float>(y, x) -= kThickness_m;
      scene.frame.colour.at<cv::Vec3b>(y, x) = beside;
    }
  }
  JointStart joint;
  joint.T_camera_object = scene.truth;
  joint.appearance.colours = std::make_shared<const ColourStatistics>(colours);
  const ObjectObservation observation =
      observe_object({scene.frame, {}, {}}, detection_of("it", scene.object, scene.truth, 1), scene.model, {});
  const JointResult result = register_jointly(observation, joint, {}, {});
  EXPECT_LT(scene.shift_of(result.registration.T_camera_object).norm(), 0.002);
  EXPECT_LT(angle_to_truth(scene, result.registration.T_camera_object), 0.02);
}

TEST(JointRegistration, AFrameWithoutColoursLeavesDepth) {
  ModalityScene scene = box_scene().copy();
  const auto colours = std::make_shared<const ColourStatistics>(scene.learnt());
  for (const int tone : {0, 255}) {
    scene.frame.colour.setTo(cv::Scalar::all(tone));
    JointStart joint;
    joint.T_camera_object = beside(scene, {0.01, -0.008, 0.012}, 0.06);
    joint.appearance.colours = colours;
    const ObjectObservation observation =
        observe_object({scene.frame, {}, {}}, detection_of("it", scene.object, scene.truth, 1), scene.model, {});
    const JointResult result = register_jointly(observation, joint, {}, {});
    EXPECT_LT(scene.shift_of(result.registration.T_camera_object).norm(), 0.003) << tone;
    EXPECT_EQ(result.edges, 0) << tone;
  }
}

TEST(JointRegistration, ATurnThatNothingObservesStaysWhatItWas) {
  const ModalityScene& scene = can_scene();
  for (const double angle : {0.3, -0.9}) {
    Eigen::Isometry3d start = scene.truth;
    start.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    Eigen::Isometry3d found = start;
    for (int i = 0; i < 10; ++i) found = registered(scene, found, true).registration.T_camera_object;
    const Eigen::Vector3d moved = rotation_vector(start.linear().transpose() * found.linear());
    EXPECT_LT(std::abs(moved.z()), 0.05) << angle;
  }
}

TEST(JointRegistration, KnowsWhichTurnsWereObserved) {
  const ModalityScene& scene = can_scene();
  const JointResult result = registered(scene, scene.truth, true);
  const Eigen::Matrix3d observed = observed_rotation(result.information, scene.model.radius, {});
  const Eigen::Vector3d axis = scene.truth.linear().col(2);
  EXPECT_LT(axis.dot(observed * axis), 0.3);
  const Eigen::Vector3d across = scene.truth.linear().col(0);
  EXPECT_GT(across.dot(observed * across), 0.7);
  const JointResult of_box = registered(box_scene(), box_scene().truth, true);
  const Eigen::Matrix3d all = observed_rotation(of_box.information, box_scene().model.radius, {});
  EXPECT_GT(all.trace(), 2.6);
}

}  // namespace
}  // namespace houghstream
