#include "pipeline/process/warm_up.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

TEST(WarmUp, TheFrameIsAWholeOneWithDepthEverywhere) {
  const RgbdFrame frame = make_warm_up_frame();
  EXPECT_NO_THROW(check_frame(frame, "test"));
  double nearest = 0.0;
  double farthest = 0.0;
  cv::minMaxLoc(frame.depth, &nearest, &farthest);
  EXPECT_GT(nearest, 0.9);
  EXPECT_LT(farthest, 1.1);
  EXPECT_GT(farthest - nearest, 0.05);
}

TEST(WarmUp, IsTheSameInAThreadOfItsOwn) {
  const RgbdFrame frame = make_warm_up_frame();
  const RgbdFrame other = start_warm_up().get();
  EXPECT_EQ(cv::norm(frame.colour, other.colour, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(frame.depth, other.depth, cv::NORM_INF), 0.0);
}

TEST(WarmUp, NoFewerThreadsThanTheWorkIsGiven) {
  EXPECT_GE(warm_up_threads(1), 1);
  EXPECT_LE(warm_up_threads(1), 8);
  EXPECT_EQ(warm_up_threads(40), 40);
}

}  // namespace
}  // namespace houghstream
