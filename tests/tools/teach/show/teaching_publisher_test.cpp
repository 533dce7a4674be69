#include "tools/teach/show/teaching_publisher.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "pipeline/messages/channels.hpp"
#include "pipeline/messages/messages.hpp"

namespace houghstream::teach {
namespace {

using std::chrono::milliseconds;
using Directions = std::array<Eigen::Vector3d, ShowProgress::kDirections>;

Directions all_up() {
  Directions directions;
  directions.fill(Eigen::Vector3d::UnitZ());
  return directions;
}

ShowProgress tracked(std::int64_t utime) {
  ShowProgress now;
  now.frame = {"OPENNI_FRAME", utime};
  now.name = "mug";
  now.state = TeachingState::kTracking;
  now.message = "seen from 2 of 60 directions";
  now.seen[0] = now.seen[7] = true;
  now.frames = 5;
  now.keyframes = 2;
  now.box = {1, 2, 3, 4};
  now.progress = 2.0 / 60.0;
  now.T_camera_object = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1));
  return now;
}

/// A bus that remembers what was said of teachings.
struct HeardTeaching {
  HeardTeaching() {
    bus.subscribe(channel::kTeaching, [this](const ReceivedMessage& arrival) {
      teachings.push_back(teaching_from_message(decode_message<houghstream::teaching_t>(arrival.bytes)));
    });
  }
  void listen(milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) bus.handle(milliseconds(20));
  }
  LcmBus bus{"memq://"};
  std::vector<Teaching> teachings;
};

TEST(TeachingPublisher, SaysOnTheBusWhatTheObserverIsTold) {
  const Teaching said = teaching_of(tracked(77), all_up());
  EXPECT_EQ(said.frame, (FrameId{"OPENNI_FRAME", 77}));
  EXPECT_EQ(said.state, TeachingState::kTracking);
  EXPECT_EQ(said.box_px, cv::Rect2f(1, 2, 3, 4));
  EXPECT_EQ(said.directions.size(), 60U);
  EXPECT_EQ(count_covered(said), 2);
  EXPECT_NEAR(*said.progress, 1.0F / 30.0F, 1e-6F);
  ShowProgress choosing;
  EXPECT_FALSE(teaching_of(choosing, all_up()).box_px.has_value());
  const std::array<std::pair<TeachingState, const char*>, 7> words = {{{TeachingState::kChoosing, "choosing"},
                                                                       {TeachingState::kTracking, "tracking"},
                                                                       {TeachingState::kLost, "lost"},
                                                                       {TeachingState::kFusing, "fusing"},
                                                                       {TeachingState::kTraining, "training"},
                                                                       {TeachingState::kDone, "done"},
                                                                       {TeachingState::kFailed, "failed"}}};
  for (const auto& [state, word] : words) {
    choosing.state = state;
    EXPECT_STREQ(to_string(teaching_of(choosing, all_up()).state), word);
  }
}

TEST(TeachingPublisher, ManyFramesAreFewMessagesAndTheLastOneIsSaidAgain) {
  HeardTeaching heard;
  TeachingPublisher publisher(heard.bus, all_up());
  for (std::int64_t i = 1; i <= 50; ++i) publisher.progress(tracked(i));
  heard.listen(milliseconds(500));
  ASSERT_GE(heard.teachings.size(), 2U);
  EXPECT_LE(heard.teachings.size(), 10U);
  EXPECT_EQ(heard.teachings.back().frame.utime, 50) << "the last one is not held back for long";
  ShowProgress fusing = tracked(50);
  fusing.state = TeachingState::kFusing;
  publisher.progress(fusing);
  heard.listen(milliseconds(50));
  EXPECT_EQ(heard.teachings.back().state, TeachingState::kFusing) << "a new state at once";
  const std::size_t before = heard.teachings.size();
  heard.listen(milliseconds(1500));
  EXPECT_GT(heard.teachings.size(), before) << "while nothing new is said";
}

TEST(CoverageCriterion, WhenMoreThanHalfWasSeenAndNothingNewComes) {
  CoverageCriterion enough;
  ShowProgress now = tracked(1'000'000);
  EXPECT_FALSE(enough(now));
  now.frame.utime = 10'000'000;
  EXPECT_FALSE(enough(now)) << "two of sixty";
  std::fill_n(now.seen.begin(), 31, true);
  EXPECT_FALSE(enough(now)) << "just seen";
  now.frame.utime += 5'000'000;
  EXPECT_FALSE(enough(now));
  now.seen[40] = true;
  now.frame.utime += 5'000'000;
  EXPECT_FALSE(enough(now)) << "again a new one";
  now.frame.utime += 6'100'000;
  EXPECT_FALSE(enough(now)) << "19 s brought new ones: a turn of which that was two thirds is not closed yet";
  now.frame.utime += 4'000'000;
  EXPECT_TRUE(enough(now));
}

// Times off the wire may be any, and a clock may be set back.
TEST(CoverageCriterion, GoesOnWhereTheClockJumps) {
  CoverageCriterion enough;
  ShowProgress now = tracked(std::numeric_limits<std::int64_t>::max());
  std::fill_n(now.seen.begin(), 31, true);
  EXPECT_FALSE(enough(now));
  now.frame.utime = std::numeric_limits<std::int64_t>::min();
  EXPECT_FALSE(enough(now));
  now.frame.utime += 5'000'000;
  EXPECT_FALSE(enough(now));
  now.frame.utime += 2'000'000;
  EXPECT_TRUE(enough(now)) << "seven seconds since it was set back";
  now.frame.utime = std::numeric_limits<std::int64_t>::max();
  EXPECT_TRUE(enough(now));
}

TEST(CoverageCriterion, AClockThatIsSetForwardOrOneWrongStampEndsNoTake) {
  constexpr std::int64_t kHour = 3'600'000'000;
  for (const std::int64_t step : {kHour, -kHour}) {
    for (const bool lasts : {true, false}) {
      CoverageCriterion enough;
      ShowProgress now = tracked(kHour);
      std::fill_n(now.seen.begin(), 31, true);
      EXPECT_FALSE(enough(now));
      now.frame.utime += step;
      EXPECT_FALSE(enough(now)) << step;
      if (!lasts) now.frame.utime -= step;
      now.frame.utime += 5'000'000;
      EXPECT_FALSE(enough(now)) << step;
      now.frame.utime += 6'500'000;
      EXPECT_TRUE(enough(now)) << step;
    }
  }
}

}  // namespace
}  // namespace houghstream::teach
