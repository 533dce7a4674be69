#include "pose/registration/pose_selection.hpp"

#include <gtest/gtest.h>

#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

struct Boxed {
  explicit Boxed(const Mesh& box = printed_box()) : mesh(box) {}

  Mesh mesh;
  ObjectModel model = make_object_model("box", mesh, {});
  Eigen::Isometry3d truth = standing(25.0, 30.0, 0.8);
  RgbdFrame frame = coloured_frame(printed_box(), truth, 5);
  DepthRegion region{cv::Rect(0, 0, 640, 480), 0.5F, 1.2F, 10000};

  std::vector<RegistrationResult> choose_all(const std::vector<PoseCandidate>& candidates,
                                             const Eigen::Vector3f& centre) const {
    ObjectObservation observation{frame, model};
    observation.centre_camera = centre;
    observation.region = region;
    observation.colours = lab_region(frame, region.box_px, {});
    const RegistrationResult best =
        best_registered(observation, register_candidates(observation, candidates, {}), {}, {});
    if (best.inliers == 0) return {best};
    return select_poses(observation, best, {}, {});
  }

  RegistrationResult choose(const std::vector<PoseCandidate>& candidates, const Eigen::Vector3f& centre) const {
    return choose_all(candidates, centre).front();
  }
};

TEST(Choice, ABoxThatWasTakenForItsBackIsTurnedRound) {
  const Boxed boxed;
  const Eigen::Vector3f centre = boxed.truth.translation().cast<float>();
  const RegistrationResult found = boxed.choose({{rotated(boxed.truth, 180.0), 1.0F}}, centre);
  ASSERT_GT(found.inliers, 0);
  const double angle = Eigen::AngleAxisd(found.T_camera_object.linear().transpose() * boxed.truth.linear()).angle();
  EXPECT_LT(angle, 0.02);
  EXPECT_LT((found.T_camera_object.translation() - boxed.truth.translation()).norm(), 0.003);
}

TEST(Choice, AHalfTurnThatPointsCannotTellApartIsChosenToo) {
  const Boxed plain(cereal_box());
  const std::vector<RegistrationResult> selected =
      plain.choose_all({{plain.truth, 1.0F}}, plain.truth.translation().cast<float>());
  ASSERT_EQ(selected.size(), 2U);
  const Eigen::Matrix3d between =
      selected[0].T_camera_object.linear().transpose() * selected[1].T_camera_object.linear();
  EXPECT_GT(Eigen::AngleAxisd(between).angle(), 3.0);
}

TEST(Choice, WhatEndsFarFromTheDetectionIsNoResult) {
  const Boxed boxed;
  const RegistrationResult found = boxed.choose({{boxed.truth, 1.0F}}, Eigen::Vector3f(0.3F, 0.0F, 0.8F));
  EXPECT_EQ(found.inliers, 0);
}

TEST(Choice, WithoutCandidatesThereIsNoResult) {
  EXPECT_EQ(Boxed().choose({}, Eigen::Vector3f(0, 0, 0.8F)).inliers, 0);
}

}  // namespace
}  // namespace houghstream
