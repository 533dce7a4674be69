#include "pipeline/types/frame_id.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace houghstream
