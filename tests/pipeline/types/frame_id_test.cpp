#include "pipeline/types/frame_id.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <unordered_set>

namespace houghstream {
namespace {

TEST(FrameId, CamerasOfEqualTimesAreTwoFrames) {
  const FrameId left{"LEFT", 5};
  const FrameId right{"RIGHT", 5};
  EXPECT_EQ(left, (FrameId{"LEFT", 5}));
  EXPECT_NE(left, right);
  EXPECT_EQ((std::set<FrameId>{right, {"A", 6}, left, left}.size()), 3U);
  EXPECT_EQ((std::unordered_set<FrameId>{right, left, left}.size()), 2U);
}

TEST(FrameId, EarlierFramesComeFirst) {
  EXPECT_LT((FrameId{"RIGHT", 4}), (FrameId{"LEFT", 5}));
  EXPECT_LT((FrameId{"LEFT", 5}), (FrameId{"RIGHT", 5}));
}

TEST(FrameId, IsPrinted) {
  EXPECT_EQ(to_string(FrameId{"LEFT", 5}), "LEFT 5");
  EXPECT_EQ(to_string(FrameId{"", 5}), "5");
}

TEST(FrameId, SecondsBetweenTimesAreNegativeWhenTheyGoBack) {
  EXPECT_DOUBLE_EQ(seconds_between(2000000, 500000), -1.5);
}

TEST(FrameId, TimesMayBeAny) {
  constexpr std::int64_t kFirst = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(microseconds_between(3, 10), 7);
  EXPECT_EQ(microseconds_between(kFirst, kLast), kLast);
  EXPECT_EQ(microseconds_between(kLast, kFirst), kFirst);
  EXPECT_EQ(microseconds_between(0, kFirst), kFirst);
  EXPECT_GT(seconds_between(kFirst, kLast), 9e12);
  EXPECT_LT(seconds_between(kLast, kFirst), -9e12);
}

}  // namespace
}  // namespace houghstream
