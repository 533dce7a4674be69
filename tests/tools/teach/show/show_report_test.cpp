#include "tools/teach/show/show_report.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/geometry/tetrahedron.hpp"

namespace houghstream::teach {
namespace {

ShowResult good_turntable() {
  ShowResult shown;
  shown.name = "apple";
  shown.takes.emplace_back();
  shown.takes.front().motion = reconstruction::Motion::kTurntable;
  shown.views.emplace_back(20);
  shown.seen_surface = 1.0;
  shown.silhouette_iou = 0.93;
  return shown;
}

TEST(ModelAssessment, OutlinesThatDoNotFitTheGivenMasksArePoor) {
  ShowResult shown = good_turntable();
  EXPECT_TRUE(assess_model(shown).good);
  shown.silhouette_iou = 0.85;
  const ModelAssessment assessment = assess_model(shown);
  EXPECT_FALSE(assessment.good);
  ASSERT_EQ(assessment.reasons.size(), 1U);
  EXPECT_EQ(assessment.reasons[0], "the model's outline overlaps with the masks by 0.85, expected at least 0.9");
}

TEST(ModelAssessment, AModelThatIsSeenThroughIsPoor) {
  ShowResult shown = good_turntable();
  shown.free_space_violation = 0.063;
  const ModelAssessment assessment = assess_model(shown);
  ASSERT_EQ(assessment.reasons.size(), 1U);
  EXPECT_EQ(
      assessment.reasons[0],
      "the model is seen through in 6 % of its outline, expected less than 2: a hand or the table was taken for it");
}

/// A whole turn that was closed.
reconstruction::Take closed_turn() {
  reconstruction::Take take;
  take.motion = reconstruction::Motion::kCamera;
  take.covered_degrees = 360;
  take.loop_error = reconstruction::LoopClosureError{0.004, 0.01};
  return take;
}

TEST(ModelAssessment, EachTakeIsJudged) {
  ShowResult shown = good_turntable();
  shown.silhouette_iou.reset();
  shown.takes = {closed_turn(), closed_turn()};
  shown.views.emplace_back(20);
  EXPECT_TRUE(assess_model(shown).good);
  shown.takes[1].covered_degrees = 120;
  shown.views[1].resize(5);
  EXPECT_EQ(assess_model(shown).reasons,
            (std::vector<std::string>{"the second take: too short: seen from 120 degrees of the turn, expected all 360",
                                      "the second take: only 5 keyframes show it"}));
}

TEST(ModelAssessment, ATakeInTheDarkIsNotCalledShortWithoutSayingWhy) {
  ShowResult shown = good_turntable();
  shown.silhouette_iou.reset();
  shown.takes = {closed_turn()};
  shown.takes[0].frames.resize(100);
  shown.takes[0].covered_degrees = 50;
  shown.takes[0].blurred = 4;
  shown.takes[0].badly_exposed = 80;
  EXPECT_EQ(
      assess_model(shown).reasons,
      (std::vector<std::string>{
          "too short: seen from 50 degrees of the turn, expected all 360; of 100 frames 4 were blurred and 80 too "
          "dark or burnt out, which count for nothing"}));
}

TEST(ModelAssessment, OfATurntableNothingIsSaidThatOnlyTrackingKnows) {
  ShowResult shown = good_turntable();
  shown.mesh = tetrahedron(0.1F);
  shown.takes.front().keyframes.resize(20);
  shown.takes.front().selected.T_camera_stand.translation() = Eigen::Vector3d(0.0, 0.0, 0.8);
  const std::string text = describe(shown, assess_model(shown));
  EXPECT_NE(text.find("  20 pictures with masks; a turntable moved\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("tracked"), std::string::npos) << text;
  EXPECT_EQ(text.find("not closed"), std::string::npos) << text;
}

TEST(ModelAssessment, WithoutGivenMasksTheirOverlapIsNotAsked) {
  ShowResult shown = good_turntable();
  shown.silhouette_iou.reset();
  EXPECT_TRUE(assess_model(shown).good);
}

}  // namespace
}  // namespace houghstream::teach
