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

}  // namespace
}  // namespace houghstream
