#include "pose/candidates.hpp"

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

}  // namespace
}  // namespace houghstream
