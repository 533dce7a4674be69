#include "pose/registration/candidates.hpp"

#include <gtest/gtest.h>

#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

TEST(Candidates, BestPlacedRotationComesFirst) {
  const Mesh object = cereal_box();
  const Mesh ground = table();
  const Eigen::Isometry3d truth = standing(60.0, 30.0, 0.9);
  const RgbdFrame frame =
      noisy_frame({{&object, truth, 1}, {&ground, truth * Eigen::Translation3d(0, 0, -0.13), 2}}, 1);
  const ObjectModel model = make_object_model("box", object, ModelSettings());
  const auto rotation = [](double azimuth) {
    return Eigen::Quaternionf(standing(azimuth, 30.0, 1.0).linear().cast<float>());
  };
  const Eigen::Vector3f centre = (truth.translation() + Eigen::Vector3d(0.01, -0.01, 0.02)).cast<float>();
  PoseSettings settings;
  const std::vector<PoseCandidate> found = place_candidates(
      frame, model, centre,
      {{rotation(150.0), 3.0F}, {rotation(60.0), 1.0F}, {rotation(100.0), 1.0F}, {rotation(330.0), 1.0F}}, settings);
  ASSERT_EQ(found.size(), static_cast<std::size_t>(settings.search.keep));
  EXPECT_GE(found[0].score, found[1].score);
  EXPECT_GE(found[1].score, found[2].score);
  EXPECT_LT((found[0].T_camera_object.translation() - truth.translation()).norm(), 0.015);
  const Eigen::Quaterniond R_camera_object(found[0].T_camera_object.linear());
  EXPECT_LT(R_camera_object.angularDistance(Eigen::Quaterniond(truth.linear())), 0.01);
}

TEST(Candidates, OfEarlierPosesOnlyThoseOfTheClassNearInTimeAndPlaceCount) {
  const Eigen::Isometry3d truth = standing(60.0, 30.0, 0.9);
  Detection detection;
  detection.class_name = "box";
  detection.centre_camera = truth.translation().cast<float>();
  ObjectPose pose;
  pose.class_name = "box";
  pose.T_camera_object = truth;
  const auto count = [&](std::int64_t utime, const ObjectPose& earlier) {
    ObjectPoses poses;
    poses.frame.utime = utime;
    poses.poses = {earlier};
    return earlier_candidates(2000000, detection, poses, {}).size();
  };
  EXPECT_EQ(count(1900000, pose), 1U);
  EXPECT_EQ(count(1400000, pose), 0U);  // too long ago
  EXPECT_EQ(count(2000000, pose), 0U);  // this frame
  EXPECT_EQ(count(2100000, pose), 0U);  // later: the log was started again
  ObjectPose other = pose;
  other.class_name = "mug";
  EXPECT_EQ(count(1900000, other), 0U);
  other = pose;
  other.T_camera_object = Eigen::Translation3d(0.2, 0.0, 0.0) * truth;
  EXPECT_EQ(count(1900000, other), 0U);
  other.T_camera_object.reset();
  EXPECT_EQ(count(1900000, other), 0U);
}

}  // namespace
}  // namespace houghstream
