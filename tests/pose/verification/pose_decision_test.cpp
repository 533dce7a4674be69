#include "pose/verification/pose_decision.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

ObjectPose seen_as(const Eigen::Vector2d& chroma, double lightness, float quality) {
  ObjectPose pose;
  pose.class_name = "bowl";
  pose.detection_score = 0.9F;
  pose.T_camera_object = Eigen::Isometry3d::Identity();
  pose.status = PoseStatus::kValid;
  pose.shape_quality = quality;
  pose.quality = 0.9F * quality;
  ChromaPair& pair = pose.chroma.emplace();
  pair.class_name = pose.class_name;
  pair.model = {0.0, 15.0};
  pair.measured = chroma;
  pair.lightness = lightness;
  pair.probability = quality;
  return pose;
}

ObjectPose beside_surer(ObjectPose pose) {
  const ObjectPose surer = seen_as({7.0, 18.0}, 50.0, 0.99F);
  compare_with_instance(surer, true, QualitySettings(), pose);
  return pose;
}

TEST(CompareWithInstance, OneOfAnotherColourThanASurerOneOfItsClassIsRejected) {
  const ObjectPose blue = beside_surer(seen_as({0.7, 1.9}, 46.0, 0.94F));
  EXPECT_FALSE(has_pose(blue.status)) << to_string(blue.status);
  EXPECT_FALSE(blue.T_camera_object.has_value());
  EXPECT_LT(blue.shape_quality, 0.6F);
  EXPECT_NEAR(blue.quality, 0.9F * blue.shape_quality, 1e-4F) << "the texture's verdict stays";
}

TEST(CompareWithInstance, OneOfTheSameColourKeepsItsQualityInTheShadeToo) {
  for (const double lightness : {50.0, 30.0}) {
    const double shade = (lightness + 16.0) / 66.0;
    const ObjectPose before = seen_as({shade * 6.0, shade * 17.0}, lightness, 0.94F);
    const ObjectPose after = beside_surer(before);
    EXPECT_EQ(after.status, PoseStatus::kValid) << lightness;
    EXPECT_NEAR(after.shape_quality, before.shape_quality, 1e-4F);
    EXPECT_NEAR(after.quality, before.quality, 1e-4F);
  }
}

TEST(CompareWithInstance, OneThatShowsAnotherSideIsComparedWithThatSide) {
  ObjectPose back = seen_as({3.0, -30.0}, 50.0, 0.94F);
  back.chroma->model = {-4.0, -33.0};
  EXPECT_EQ(beside_surer(back).status, PoseStatus::kValid);
  back.chroma->measured = {40.0, 20.0};
  EXPECT_EQ(beside_surer(back).status, PoseStatus::kRefuted);
}

TEST(CompareWithInstance, TheDetectionIsRefutedUnlessItsObjectIsThereWhateverItsPose) {
  EXPECT_EQ(beside_surer(seen_as({0.7, 1.9}, 46.0, 0.94F)).status, PoseStatus::kRefuted);
  QualitySettings hard_to_pose;
  hard_to_pose.presence.bias = 2.0;
  ObjectPose pose = seen_as({0.7, 1.9}, 46.0, 0.94F);
  compare_with_instance(seen_as({7.0, 18.0}, 50.0, 0.99F), true, hard_to_pose, pose);
  EXPECT_EQ(pose.status, PoseStatus::kRejectedByColour);
}

}  // namespace
}  // namespace houghstream
