#include "pipeline/process/warm_up.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

TEST(WarmUp, TheFrameIsAWholeOneWithDepthEverywhere) {
  const RgbdFrame frame = frame_to_warm_up();
  EXPECT_NO_THROW(check_frame(frame, "test"));
  double nearest = 0.0;
  double farthest = 0.0;
  cv::minMaxLoc(frame.depth, &nearest, &farthest);
  EXPECT_GT(nearest, 0.9);
  EXPECT_LT(farthest, 1.1);
  EXPECT_GT(farthest - nearest, 0.05);
}

TEST(WarmUp, IsTheSameInAThreadOfItsOwn) {
  const RgbdFrame frame = frame_to_warm_up();
  const RgbdFrame other = begin_to_warm_up().get();
  EXPECT_EQ(cv::norm(frame.colour, other.colour, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(frame.depth, other.depth, cv::NORM_INF), 0.0);
}

TEST(WarmUp, NoFewerThreadsThanTheWorkIsGiven) {
  EXPECT_GE(threads_to_start(1), 1);
  EXPECT_LE(threads_to_start(1), 8);
  EXPECT_EQ(threads_to_start(40), 40);
}

}  // namespace
}  // namespace houghstream
