#include "tools/evaluate/metrics/followed_poses.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

constexpr double kMinVisibleOfCan = 0.1;

// Right below 20 mm: a tenth of the diameter.
const std::map<std::string, PoseModel> kCanModels = {{"can", {{{0.0F, 0.0F, 0.1F}, {0.0F, 0.1F, 0.0F}}, 0.2}}};

Eigen::Isometry3d shifted_by(double x) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, 1.0));
}

NamedObject shifted_can(double x, double visible = 1.0) {
  NamedObject out;
  out.class_name = "can";
  out.truth.has_pose = true;
  out.truth.visible_fraction = visible;
  out.truth.T_camera_object = shifted_by(x);
  return out;
}

ObjectPose followed_can(double x) {
  ObjectPose out;
  out.class_name = "can";
  out.status = PoseStatus::kValid;
  out.T_camera_object = shifted_by(x);
  return out;
}

EvaluatedFrame followed_frame(std::vector<NamedObject> objects, std::optional<std::vector<ObjectPose>> poses) {
  EvaluatedFrame frame;
  frame.objects = std::move(objects);
  if (poses) frame.followed = ObjectPoses{{}, std::move(*poses), {}};
  return frame;
}

FollowedPoses count_in(const std::vector<EvaluatedFrame>& frames) {
  return count_followed_poses(frames, {"can", "mug"}, kCanModels, kMinVisibleOfCan).value();
}

TEST(FollowedPoses, ObjectsOfFramesThatWerePassedOverAreMissed) {
  const FollowedPoses found =
      count_in({followed_frame({shifted_can(0.0)}, {{followed_can(0.001)}}), followed_frame({shifted_can(0.0)}, {})});
  EXPECT_EQ(found.frames, 1);
  EXPECT_EQ(found.frames_missed, 1);
  const FollowedCount can = found.by_class.at("can");
  EXPECT_EQ(can.required, 2);
  EXPECT_EQ(can.published, 1);
  EXPECT_EQ(can.correct, 1);
  EXPECT_EQ(found.by_class.count("mug"), 0U) << "it has no model";
}

TEST(FollowedPoses, AFarOneIsWrongAndOneWithoutPoseIsNotPublished) {
  ObjectPose occluded;
  occluded.class_name = "can";
  occluded.status = PoseStatus::kOccluded;
  const FollowedCount can = count_in({followed_frame({shifted_can(0.0)}, {{followed_can(0.03), occluded}})}).all();
  EXPECT_EQ(can.published, 1);
  EXPECT_EQ(can.correct, 0);
}

TEST(FollowedPoses, EachObjectIsFoundOnceByTheNearestPose) {
  const FollowedCount can =
      count_in({followed_frame({shifted_can(0.0), shifted_can(0.5)},
                               {{followed_can(0.012), followed_can(0.001), followed_can(0.501)}})})
          .all();
  EXPECT_EQ(can.required, 2);
  EXPECT_EQ(can.published, 3);
  EXPECT_EQ(can.correct, 2) << "the first can has two poses within 20 mm, of which one counts";
}

TEST(FollowedPoses, AnObjectThatIsHardlyVisibleIsNeitherRequiredNorWrong) {
  const FollowedCount can = count_in({followed_frame({shifted_can(0.0, 0.05)}, {{followed_can(0.2)}})}).all();
  EXPECT_EQ(can.required, 0);
  EXPECT_EQ(can.published, 0);
}

TEST(FollowedPoses, AreNothingWhereNoneWerePublished) {
  EXPECT_FALSE(count_followed_poses({followed_frame({shifted_can(0.0)}, {})}, {"can"}, kCanModels, kMinVisibleOfCan)
                   .has_value());
}

}  // namespace
}  // namespace houghstream
