#include "pose/registration/pair_block.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(PairBlock, FindsTheNearestPointOfAStep) {
  RgbdFrame frame;
  frame.camera = {80, 60, 70.0, 70.0, 40.0, 30.0};
  frame.depth = cv::Mat(60, 80, CV_32FC1, cv::Scalar(0.9F));
  frame.depth.colRange(43, 80).setTo(0.8F);
  PairBlock block;
  block.count = 2;
  block.z[0] = block.z[1] = 0.8F;
  block.x[1] = 0.3F;  // well onto the step
  find_gaps(frame, {0.05F, 2}, block);
  EXPECT_NEAR(block.gap_x[0], 4.0 / 70.0 * 0.8, 0.012);  // from the middle to a pixel of the lattice beyond column 43
  EXPECT_NEAR(block.gap_z[0], 0.0, 1e-6);
  EXPECT_LT(block.distance_sq[1], 0.006F * 0.006F);
}

TEST(PairBlock, NothingWithinReachIsNoGap) {
  RgbdFrame frame;
  frame.camera = {80, 60, 70.0, 70.0, 40.0, 30.0};
  frame.depth = cv::Mat(60, 80, CV_32FC1, cv::Scalar(0.9F));
  PairBlock block;
  block.count = 2;
  block.z[0] = block.z[1] = 0.8F;
  block.x[1] = 5.0F;  // outside the image
  find_gaps(frame, {0.05F, 2}, block);
  for (std::size_t i = 0; i < block.count; ++i) {
    EXPECT_EQ(block.distance_sq[i], 0.05F * 0.05F);
    EXPECT_EQ(block.gap_z[i], 0.0F);
  }
}

}  // namespace
}  // namespace houghstream
