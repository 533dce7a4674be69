#include "pose/following/follow.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

TEST(FollowObjects, AnObjectWithoutAModelHasAReasonAndNoResidual) {
  const PoseEstimator estimator({{"box", cereal_box()}}, PoseSettings());
  ExpectedObject mug;
  mug.class_id = 2;
  mug.class_name = "mug";
  mug.score = 0.5F;
  mug.initial_poses = {standing(0.0, 30.0, 1.0)};
  const Mesh box = cereal_box();
  const RgbdFrame frame = noisy_frame({{&box, mug.initial_poses.front(), 1}}, 1);
  const std::vector<FollowedPose> followed = follow_objects(estimator, {}, frame, {mug});
  ASSERT_EQ(followed.size(), 1U);
  EXPECT_EQ(followed[0].pose.status, PoseStatus::kNoModel);
  EXPECT_EQ(followed[0].pose.class_name, "mug");
  EXPECT_TRUE(std::isnan(followed[0].pose.residual));
  EXPECT_FALSE(followed[0].pose.T_camera_object.has_value());
  EXPECT_TRUE(followed[0].T_camera_object.isApprox(mug.initial_poses.front()));
}

}  // namespace
}  // namespace houghstream
