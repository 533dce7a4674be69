#include "pose/verification/verification.hpp"

#include <gtest/gtest.h>

#include "pipeline/geometry/renderer.hpp"
#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

const DepthTolerance kDepthTolerance{0.008, DepthNoise()};

struct BoxOnTable {
  Mesh object = cereal_box();
  Mesh ground = table();
  Eigen::Isometry3d truth = standing(30.0, 30.0, 1.0);
  RgbdFrame frame = noisy_frame({{&object, truth, 1}, {&ground, truth* Eigen::Translation3d(0, 0, -0.13), 2}}, 1);
};

TEST(Verification, TruePoseAgreesAlmostEverywhere) {
  const BoxOnTable scene;
  const Verification found = verify_pose(scene.frame, scene.object, scene.truth, kDepthTolerance);
  EXPECT_GT(found.rendered, 5000);
  EXPECT_GT(found.visible_fraction(), 0.95F);  // 2 % of the depth is lost
  EXPECT_LT(found.free_space_violation(), 0.01F);
  EXPECT_EQ(found.occluded, 0);
  EXPECT_GT(found.boundary_samples, 200);
  EXPECT_LT(found.boundary_continuations, 0.15F * static_cast<float>(found.boundary_samples));
}

TEST(Verification, ModelInFrontOfWhatWasSeenViolatesFreeSpace) {
  const BoxOnTable scene;
  Eigen::Isometry3d nearer = scene.truth;
  nearer.translation() *= 0.9;
  const Verification found = verify_pose(scene.frame, scene.object, nearer, kDepthTolerance);
  EXPECT_GT(found.free_space_violation(), 0.9F);
}

TEST(Verification, ModelBehindWhatWasSeenIsOccludedNotContradicted) {
  const BoxOnTable scene;
  Eigen::Isometry3d farther = scene.truth;
  farther.translation() *= 1.1;
  const Verification found = verify_pose(scene.frame, scene.object, farther, kDepthTolerance);
  EXPECT_GT(found.occluded, 0.8 * found.rendered);
  EXPECT_LT(found.free_space_violation(), 0.1F);
}

TEST(Verification, PointsOfAViewTellWhatRenderedPixelsTell) {
  const BoxOnTable scene;
  const ObjectModel model = make_object_model("box", scene.object, ModelSettings());
  for (const double scale : {0.9, 0.99, 1.0, 1.01, 1.1}) {
    Eigen::Isometry3d pose = scene.truth;
    pose.translation() *= scale;
    const Verification pixels = verify_pose(scene.frame, scene.object, pose, kDepthTolerance);
    const Verification points = verify_projected_view(project_view(scene.frame, model, pose, 600), kDepthTolerance);
    EXPECT_GT(points.rendered, 300);
    EXPECT_NEAR(points.visible_fraction(), pixels.visible_fraction(), 0.06) << scale;
    EXPECT_NEAR(points.free_space_violation(), pixels.free_space_violation(), 0.06) << scale;
    EXPECT_EQ(points.boundary_samples, 0);
  }
}

/// Its large face in the table's.
Eigen::Isometry3d sunk_into_the_table(const BoxOnTable& scene) {
  Eigen::Isometry3d sunk = scene.truth * Eigen::Translation3d(-0.3, 0.2, -0.13 - 0.03);
  sunk.rotate(Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitX()));
  return sunk;
}

TEST(Verification, FaceSunkIntoTheTableAgreesButHasNoOutline) {
  const BoxOnTable scene;
  const Verification found = verify_pose(scene.frame, scene.object, sunk_into_the_table(scene), kDepthTolerance);
  EXPECT_GT(found.visible_fraction(), 0.4F);
  EXPECT_LT(found.free_space_violation(), 0.01F);
  EXPECT_GT(found.boundary_samples, 200);
  EXPECT_GT(found.boundary_continuations, 0.8F * static_cast<float>(found.boundary_samples));
}

TEST(Verification, WhatIsFlushWithTheTableEndsWhereItsColourDoes) {
  const BoxOnTable scene;
  const Eigen::Isometry3d pose = sunk_into_the_table(scene);
  const auto goes_on = [&](const cv::Mat& lab) {
    const LabRegion colours{lab, {}, {}};
    const Verification found = verify_pose(scene.frame, scene.object, pose, kDepthTolerance, &colours);
    return found.boundary_continuations / static_cast<float>(found.boundary_samples);
  };
  cv::Mat lab(scene.frame.depth.size(), CV_8UC3, cv::Scalar(120, 128, 128));
  EXPECT_GT(goes_on(lab), 0.7F) << "all of one colour";
  const RenderedRegion part = render_depth_region(scene.object, pose, scene.frame.camera);
  const cv::Mat is_object = part.depth == part.depth;  // not NaN
  lab(part.region_px).setTo(cv::Scalar(120, 170, 160), is_object);
  EXPECT_LT(goes_on(lab), 0.05F) << "the object is red";
}

TEST(Verification, OutsideTheImageNothingIsRendered) {
  const BoxOnTable scene;
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(5, 0, 1), Eigen::Vector3d(0, 0, -1)}) {
    Eigen::Isometry3d outside = scene.truth;
    outside.translation() = place;
    const Verification found = verify_pose(scene.frame, scene.object, outside, kDepthTolerance);
    EXPECT_EQ(found.rendered, 0);
    EXPECT_EQ(found.visible_fraction(), 0.0F);
    EXPECT_EQ(found.free_space_violation(), 0.0F);
  }
  Eigen::Isometry3d half = scene.truth;
  half.translation().x() = -0.62;  // cut by the left border
  EXPECT_GT(verify_pose(scene.frame, scene.object, half, kDepthTolerance).rendered, 100);
}

}  // namespace
}  // namespace houghstream
