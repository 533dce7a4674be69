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

TEST(Verdict, OutlinesThatDoNotFitTheGivenMasksArePoor) {
  ShowResult shown = good_turntable();
  EXPECT_TRUE(judge(shown).good);
  shown.silhouette_iou = 0.85;
  const Verdict verdict = judge(shown);
  EXPECT_FALSE(verdict.good);
  ASSERT_EQ(verdict.reasons.size(), 1U);
  EXPECT_EQ(verdict.reasons[0], "the model's outline overlaps with the masks by 0.85, expected at least 0.9");
}

TEST(Verdict, AModelThatIsSeenThroughIsPoor) {
  ShowResult shown = good_turntable();
  shown.seen_through = 0.063;
  const Verdict verdict = judge(shown);
  ASSERT_EQ(verdict.reasons.size(), 1U);
  EXPECT_EQ(
      verdict.reasons[0],
      "the model is seen through in 6 % of its outline, expected less than 2: a hand or the table was taken for it");
}

/// A whole turn that was closed.
reconstruction::Take closed_turn() {
  reconstruction::Take take;
  take.motion = reconstruction::Motion::kCamera;
  take.degrees_round = 360;
  take.gap = reconstruction::LoopClosureError{0.004, 0.01};
  return take;
}

TEST(Verdict, EachTakeIsJudged) {
  ShowResult shown = good_turntable();
  shown.silhouette_iou.reset();
  shown.takes = {closed_turn(), closed_turn()};
  shown.views.emplace_back(20);
  EXPECT_TRUE(judge(shown).good);
  shown.takes[1].degrees_round = 120;
  shown.views[1].resize(5);
  EXPECT_EQ(judge(shown).reasons,
            (std::vector<std::string>{"the second take: too short: seen from 120 degrees of the turn, expected all 360",
                                      "the second take: only 5 keyframes show it"}));
}

TEST(Verdict, ATakeInTheDarkIsNotCalledShortWithoutSayingWhy) {
  ShowResult shown = good_turntable();
  shown.silhouette_iou.reset();
  shown.takes = {closed_turn()};
  shown.takes[0].frames.resize(100);
  shown.takes[0].degrees_round = 50;
  shown.takes[0].blurred = 4;
  shown.takes[0].badly_exposed = 80;
  EXPECT_EQ(
      judge(shown).reasons,
      (std::vector<std::string>{
          "too short: seen from 50 degrees of the turn, expected all 360; of 100 frames 4 were blurred and 80 too "
          "dark or burnt out, which count for nothing"}));
}

TEST(Verdict, OfATurntableNothingIsSaidThatOnlyTrackingKnows) {
  ShowResult shown = good_turntable();
  shown.mesh = tetrahedron(0.1F);
  shown.takes.front().keyframes.resize(20);
  shown.takes.front().chosen.T_camera_stand.translation() = Eigen::Vector3d(0.0, 0.0, 0.8);
  const std::string text = describe(shown, judge(shown));
  EXPECT_NE(text.find("  20 pictures with masks; a turntable moved\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("tracked"), std::string::npos) << text;
  EXPECT_EQ(text.find("not closed"), std::string::npos) << text;
}

TEST(Verdict, WithoutGivenMasksTheirOverlapIsNotAsked) {
  ShowResult shown = good_turntable();
  shown.silhouette_iou.reset();
  EXPECT_TRUE(judge(shown).good);
}

}  // namespace
}  // namespace houghstream::teach
