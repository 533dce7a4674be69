#include "tools/studies/pose/pose_trials.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/pose/test_scene.hpp"
#include "tools/studies/pose/pose_bench.hpp"

namespace houghstream {
namespace {

const cv::Rect kBox(100, 100, 80, 80);

/// Returns a corner of three points, 0.2 m in diameter.
std::map<std::string, ScoredModel> corner() {
  ScoredModel model;
  model.surface.points = {{0.1F, 0.0F, 0.0F}, {0.0F, 0.1F, 0.0F}, {0.0F, 0.0F, 0.1F}};
  model.surface.diameter = 0.2;
  return {{"corner", model}};
}

Detection detection(const cv::Rect& box, float score) {
  Detection out;
  out.class_name = "corner";
  out.box_px = box;
  out.score = score;
  return out;
}

Eigen::Isometry3d at(double x, double z) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x, 0.0, z);
  return T;
}

/// Returns the run of one corner at 2 m, detected correctly, and incorrectly beside it; both have the pose of `maker`.
PoseRun one_frame(const PoseMaker& maker) {
  EvaluatedFrame frame;
  NamedObject object{"corner", {}};
  object.truth.box_visible_px = kBox;
  object.truth.visible_fraction = 0.8;
  object.truth.T_camera_object = at(0.0, 2.0);
  frame.objects = {object};
  frame.detections = Detections{{}, {detection(kBox, 0.9F), detection({300, 100, 80, 80}, 0.4F)}, {}};
  TimedPoses made = maker(RgbdFrame{}, *frame.detections);
  frame.poses = made.poses;
  return {"desk", {frame}, {made.ms}};
}

class FixedRival : public BaselineEstimator {
 public:
  explicit FixedRival(std::optional<Eigen::Isometry3d> pose) : pose_(std::move(pose)) {}
  std::optional<Eigen::Isometry3d> estimate(const RgbdFrame&, const Detection&) const override { return pose_; }

 private:
  std::optional<Eigen::Isometry3d> pose_;
};

TEST(PoseTrials, ErrorsAreOfTheTrueObjectOrOfTheNearest) {
  const std::vector<PoseTrial> trials =
      match_run(one_frame(baseline_maker(std::make_unique<FixedRival>(at(0.01, 2.0)))), corner());
  ASSERT_EQ(trials.size(), 2U);
  EXPECT_EQ(trials[0].outcome, MatchOutcome::kTruePositive);
  EXPECT_EQ(trials[0].status, PoseStatus::kValid);
  EXPECT_NEAR(trials[0].add, 0.05, 1e-6);
  EXPECT_NEAR(trials[0].shift_m, 0.01, 1e-9);
  EXPECT_NEAR(trials[0].angle_deg, 0.0, 1e-6);
  EXPECT_NEAR(trials[0].distance_m, 2.0, 1e-9);
  EXPECT_TRUE(trials[0].is_correct());
  EXPECT_GE(trials[0].ms, 0.0);
  EXPECT_EQ(trials[1].outcome, MatchOutcome::kFalsePositive);
  EXPECT_NEAR(trials[1].add, 0.05, 1e-6);
  EXPECT_TRUE(std::isnan(trials[1].visible_fraction));
  EXPECT_FALSE(trials[1].is_correct());
}

TEST(EstimatorMaker, JudgesADetectionByTheOthersOfItsFrameAndSharesTheFramesTimeAmongPublishedPoses) {
  const Mesh mug = test_scene::mug();
  const Mesh table = test_scene::table();
  const Eigen::Isometry3d truth = test_scene::standing(30.0, 30.0, 0.8);
  const RgbdFrame frame =
      test_scene::noisy_frame({{&mug, truth, 1}, {&table, truth * Eigen::Translation3d(0, 0, -0.05), 2}}, 3);
  Detections two;
  two.frame = frame.id;
  for (const std::uint64_t seed : {5, 6}) two.detections.push_back(test_scene::detection_of("mug", mug, truth, seed));
  const TimedPoses made = estimator_maker({{"mug", mug}}, {})(frame, two);
  ASSERT_EQ(made.poses.poses.size(), 2U);
  EXPECT_NE(made.poses.poses[0].T_camera_object.has_value(), made.poses.poses[1].T_camera_object.has_value());
  ASSERT_EQ(made.ms.size(), 2U);
  EXPECT_GT(made.ms[0], 0.0);
  EXPECT_EQ(made.ms[0], made.ms[1]);
}

TEST(PoseTrials, ATurnedPoseIsRightUpToItsShapeOnly) {
  const Eigen::Isometry3d rotation(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ()));
  ScoredModel bar;
  bar.surface = {{{0.1F, 0.0F, 0.0F}, {-0.1F, 0.0F, 0.0F}}, 0.2};
  for (const bool is_listed : {false, true}) {
    if (is_listed) bar.surface.symmetries.push_back(rotation);
    const std::vector<PoseTrial> trials =
        match_run(one_frame(baseline_maker(std::make_unique<FixedRival>(at(0.0, 2.0) * rotation))), {{"corner", bar}});
    EXPECT_EQ(trials.at(0).is_correct(), is_listed);
    EXPECT_TRUE(trials.at(0).is_correct_up_to_shape());
    EXPECT_NEAR(trials.at(0).strict, is_listed ? 0.0 : 1.0, 1e-6);
  }
}

TEST(PoseTrials, WithoutAPoseNoErrorIsKnown) {
  const std::vector<PoseTrial> trials =
      match_run(one_frame(baseline_maker(std::make_unique<FixedRival>(std::nullopt))), corner());
  ASSERT_EQ(trials.size(), 2U);
  EXPECT_EQ(trials[0].status, PoseStatus::kNotConverged);
  EXPECT_FALSE(trials[0].T_camera_object.has_value());
  EXPECT_TRUE(std::isnan(trials[0].add_s));
  EXPECT_TRUE(std::isnan(trials[0].strict));
  EXPECT_FALSE(trials[0].is_correct());
}

}  // namespace
}  // namespace houghstream
