#include "pipeline/process/detection_throttle.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

namespace houghstream {
namespace {

/// Returns the processed frames of a 60 Hz camera, from 0 on.
std::vector<int> looks(DetectionThrottle& budget, int frames, const std::string& camera = "LEFT") {
  std::vector<int> due;
  for (int i = 0; i < frames; ++i) {
    if (budget.is_due({camera, 5000000 + i * 16667})) due.push_back(i);
  }
  return due;
}

TEST(DetectionThrottle, WithoutOneEveryFrameIsLookedAt) {
  DetectionThrottle budget(0.0, 0.0);
  EXPECT_EQ(looks(budget, 3), (std::vector<int>{0, 1, 2}));
}

TEST(DetectionThrottle, EveryFrameOfACamerasFirstHalfSecondIsLookedAt) {
  DetectionThrottle budget(5.0);
  std::vector<int> first(30);
  std::iota(first.begin(), first.end(), 0);
  const std::vector<int> due = looks(budget, 60);
  ASSERT_GE(due.size(), first.size());
  EXPECT_EQ(std::vector<int>(due.begin(), due.begin() + 30), first);
  EXPECT_LE(due.size(), 33U) << "five times a second from then on";
  EXPECT_TRUE(budget.is_due({"RIGHT", 900000000}));
  EXPECT_TRUE(budget.is_due({"RIGHT", 900016667})) << "each camera has its own start";
}

TEST(DetectionThrottle, AFrameThatWasOvertakenAtTheStartIsNotLookedAt) {
  DetectionThrottle budget(5.0);
  EXPECT_TRUE(budget.is_due({"LEFT", 5000000}));
  EXPECT_TRUE(budget.is_due({"LEFT", 5050000}));
  EXPECT_FALSE(budget.is_due({"LEFT", 5020000}));
}

TEST(DetectionThrottle, LooksAreSpreadEvenlyWhateverTheTimesTremble) {
  DetectionThrottle budget(5.0, 0.0);
  EXPECT_EQ(looks(budget, 40), (std::vector<int>{0, 12, 24, 36}));
  EXPECT_TRUE(budget.is_due({"RIGHT", 5000000})) << "each camera has its own";
  DetectionThrottle trembling(5.0, 0.0);
  EXPECT_TRUE(trembling.is_due({"LEFT", 1000}));
  EXPECT_FALSE(trembling.is_due({"LEFT", 1000 + 190000}));
  EXPECT_TRUE(trembling.is_due({"LEFT", 1000 + 199000}));
}

TEST(DetectionThrottle, ALossBringsTheNextLookForwardOnce) {
  DetectionThrottle budget(5.0, 0.0);
  EXPECT_TRUE(budget.is_due({"LEFT", 0}));
  budget.expedite("LEFT");
  EXPECT_FALSE(budget.is_due({"LEFT", 40000}));
  EXPECT_TRUE(budget.is_due({"LEFT", 50000}));
  EXPECT_FALSE(budget.is_due({"LEFT", 100000}));
  EXPECT_TRUE(budget.is_due({"LEFT", 250000}));
}

TEST(DetectionThrottle, ADoubtBringsTheNextLookForwardOnce) {
  DetectionThrottle budget(5.0, 0.0);
  budget.note_doubts("LEFT", 3);
  EXPECT_TRUE(budget.is_due({"LEFT", 0}));
  budget.note_doubts("LEFT", 1);
  EXPECT_TRUE(budget.is_due({"LEFT", 50000}));
  budget.note_doubts("LEFT", 1);
  EXPECT_FALSE(budget.is_due({"LEFT", 100000})) << "it was doubtful before";
  budget.note_doubts("LEFT", 0);
  EXPECT_FALSE(budget.is_due({"LEFT", 101000}));
  budget.note_doubts("LEFT", 1);
  EXPECT_TRUE(budget.is_due({"LEFT", 102000})) << "it has become so again";
}

TEST(DetectionThrottle, ALossOfACameraThatIsNotKnownTakesNoCamerasPlace) {
  DetectionThrottle budget(5.0, 0.0);
  for (std::size_t i = 0; i < DetectionThrottle::kCameras; ++i) budget.expedite("FORGED_" + std::to_string(i));
  EXPECT_TRUE(budget.is_due({"LEFT", 0}));
  EXPECT_FALSE(budget.is_due({"LEFT", 40000}));
}

TEST(DetectionThrottle, EveryFrameOfACameraTooManyIsLookedAt) {
  DetectionThrottle budget(5.0, 0.0);
  EXPECT_TRUE(budget.is_due({"LEFT", 0}));
  for (std::size_t i = 1; i < DetectionThrottle::kCameras; ++i)
    EXPECT_TRUE(budget.is_due({"FORGED_" + std::to_string(i), 0}));
  EXPECT_EQ(looks(budget, 3, "LATE"), (std::vector<int>{0, 1, 2}));
  EXPECT_FALSE(budget.is_due({"LEFT", 40000})) << "the others have theirs";
  EXPECT_FALSE(budget.is_due({"FORGED_1", 40000}));
}

TEST(DetectionThrottle, TimesMayBeAny) {
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  DetectionThrottle budget(1.0, 0.0);
  EXPECT_TRUE(budget.is_due({"LEFT", kFirst}));
  EXPECT_TRUE(budget.is_due({"LEFT", kLast}));
  EXPECT_TRUE(budget.is_due({"LEFT", kFirst}));
  EXPECT_FALSE(budget.is_due({"LEFT", kFirst + 500000}));
}

TEST(DetectionThrottle, AClockThatIsSetAndOneWrongStampStopNoLooks) {
  constexpr std::int64_t kHour = 3600000000;
  DetectionThrottle budget(5.0, 0.0);
  std::int64_t utime = 0;
  const auto looks_of_a_second = [&] {
    int looks = 0;
    for (int i = 0; i < 60; ++i) looks += budget.is_due({"LEFT", utime += 16667}) ? 1 : 0;
    return looks;
  };
  for (const std::int64_t step : {-kHour, kHour, -1500000L}) {
    utime += step;
    EXPECT_GE(looks_of_a_second(), 4) << step;
    EXPECT_LE(looks_of_a_second(), 6) << step;
  }
  EXPECT_TRUE(budget.is_due({"LEFT", utime + 8760 * kHour}));
  EXPECT_GE(looks_of_a_second(), 4);
  utime -= 700000;
  looks_of_a_second();
  EXPECT_GE(looks_of_a_second(), 4) << "the second after a step of less than one";
}

TEST(DetectionThrottle, AFrameThatWasOvertakenIsNoReasonToLook) {
  DetectionThrottle budget(5.0, 0.0);
  EXPECT_TRUE(budget.is_due({"LEFT", 5000000}));
  EXPECT_FALSE(budget.is_due({"LEFT", 4983333}));
  EXPECT_FALSE(budget.is_due({"LEFT", 4100000}));
  EXPECT_FALSE(budget.is_due({"LEFT", 5180000}));
  EXPECT_TRUE(budget.is_due({"LEFT", 5200000}));
}

TEST(DetectionThrottle, TimesThatGoBackBeginAnew) {
  DetectionThrottle budget(1.0, 0.0);
  EXPECT_TRUE(budget.is_due({"LEFT", 9000000}));
  EXPECT_TRUE(budget.is_due({"LEFT", 0}));
  EXPECT_FALSE(budget.is_due({"LEFT", 500000}));
}

}  // namespace
}  // namespace houghstream
