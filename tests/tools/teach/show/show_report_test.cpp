#include "tools/teach/show/show_report.hpp"

#include <gtest/gtest.h>

namespace houghstream::teach {
namespace {

Shown good_turntable() {
  Shown shown;
  shown.name = "apple";
  shown.takes.emplace_back();
  shown.takes.front().motion = reconstruction::Motion::kTurntable;
  shown.views.emplace_back(20);
  shown.seen.assign(100, true);
  shown.outline_overlap = 0.93;
  return shown;
}

TEST(Verdict, OutlinesThatDoNotFitTheGivenMasksArePoor) {
  Shown shown = good_turntable();
  EXPECT_TRUE(judge(shown).good);
  shown.outline_overlap = 0.85;
  const Verdict verdict = judge(shown);
  EXPECT_FALSE(verdict.good);
  ASSERT_EQ(verdict.reasons.size(), 1U);
  EXPECT_EQ(verdict.reasons[0], "the model's outline overlaps with the masks by 0.85, expected at least 0.9");
}

TEST(Verdict, AModelThatIsSeenThroughIsPoor) {
  Shown shown = good_turntable();
  shown.seen_through = 0.063;
  const Verdict verdict = judge(shown);
  ASSERT_EQ(verdict.reasons.size(), 1U);
  EXPECT_EQ(
      verdict.reasons[0],
      "the model is seen through in 6 % of its outline, expected less than 2: a hand or the table was taken for it");
}

TEST(Verdict, WithoutGivenMasksTheirOverlapIsNotAsked) {
  Shown shown = good_turntable();
  shown.outline_overlap.reset();
  EXPECT_TRUE(judge(shown).good);
}

}  // namespace
}  // namespace houghstream::teach
