#include "pose/registration/registration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/pose/registration_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

TEST(Registration, OursComesBackFromStartsTwentyDegreesAndTwentyMillimetresOff) {
  Random random(11);
  for (const bool is_box : {true, false}) {
    const RegistrationScene scene(is_box ? cereal_box() : mug(), is_box ? -0.13 : -0.05, standing(35.0, 30.0, 0.9));
    for (int i = 0; i < 10; ++i) {
      const Eigen::Isometry3d start = perturbed(scene.truth, 12.0 + 0.8 * i, 0.02, random);
      const RegistrationResult found = scene.projective(start);
      EXPECT_TRUE(found.converged);
      EXPECT_LT(scene.error(found), 0.003) << i << is_box;
      EXPECT_GT(found.inlier_fraction, 0.8F);
      EXPECT_LT(found.residual, 0.004F);
    }
  }
}

TEST(Registration, NothingToPairWithIsNotConvergedAndLeavesTheStart) {
  RegistrationScene scene(mug(), -0.05, standing(35.0, 30.0, 0.9));
  scene.frame.depth.setTo(std::nanf(""));
  Eigen::Isometry3d outside = scene.truth;
  outside.translation() = Eigen::Vector3d(0.0, 0.0, -1.0);
  for (const Eigen::Isometry3d& start : {scene.truth, outside}) {
    const RegistrationResult ours = scene.projective(start);
    EXPECT_FALSE(ours.converged);
    EXPECT_EQ(ours.inliers, 0);
    EXPECT_TRUE(std::isnan(ours.residual));
    EXPECT_EQ(ours.T_camera_object.matrix(), start.matrix());
  }
}

TEST(Registration, CandidatesKeepTheirOrderAndFineRegistrationThatLeavesTheDetectionIsDropped) {
  const RegistrationScene scene(cereal_box(), -0.13, standing(35.0, 30.0, 0.9));
  const ObjectObservation observation = scene.seen();
  Eigen::Isometry3d away = scene.truth;
  away.translation().z() += 0.5;
  const std::vector<RegistrationResult> found =
      register_candidates(observation, {{away, 1.0F}, {scene.truth, 0.0F}}, {});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].inliers, 0);
  EXPECT_FALSE(is_near_detection(observation, found[0], {}));
  EXPECT_LT(scene.error(found[1]), 0.003);
  EXPECT_TRUE(is_near_detection(observation, found[1], {}));
  RegistrationSettings strict;
  strict.max_shift_m = 0.0;
  EXPECT_EQ(register_finely(observation, found[1], strict).iterations, found[1].iterations);
  EXPECT_GT(register_finely(observation, found[1], {}).iterations, found[1].iterations);
}

TEST(Registration, PairDistancesGrowWithDepthsNoise) {
  const RegistrationScene scene(mug(), -0.05, standing(35.0, 30.0, 0.9));
  ObjectObservation observation = scene.seen();
  const RegistrationSettings settings;
  const CorrespondenceDistances near = correspondence_distances(observation, settings);
  EXPECT_EQ(near.start, settings.max_correspondence_start_m);
  EXPECT_GT(near.end, settings.max_correspondence_end_m);
  observation.centre_camera.z() = 4.0F;
  const CorrespondenceDistances far = correspondence_distances(observation, settings);
  EXPECT_GT(far.end, settings.max_correspondence_start_m);
  EXPECT_EQ(far.start, far.end) << "registration never ends with wider pairs than it begins with";
}

}  // namespace
}  // namespace houghstream
