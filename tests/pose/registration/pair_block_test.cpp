#include "pose/registration/pair_block.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "pipeline/base/random.hpp"
#include "tests/every_target.hpp"

namespace houghstream {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A rough wall 0.8 m away with holes; its rows lie apart in memory.
RgbdFrame rough_wall(cv::Mat& memory) {
  Random random(3);
  RgbdFrame frame;
  frame.camera = {80, 60, 70.0, 72.0, 39.5, 29.5};
  memory.create(60, 96, CV_32FC1);
  for (int y = 0; y < memory.rows; ++y) {
    for (int x = 0; x < memory.cols; ++x) {
      const bool hole = random.uniform() < 0.1;
      memory.at<float>(y, x) = hole ? kNan : static_cast<float>(random.uniform(0.77, 0.83));
    }
  }
  frame.depth = memory(cv::Rect(0, 0, 80, 60));
  return frame;
}

/// Points about the wall, some outside the image or right before the camera.
PairBlock points_about(std::size_t count) {
  Random random(5);
  PairBlock block;
  block.count = count;
  for (std::size_t i = 0; i < count; ++i) {
    block.x[i] = static_cast<float>(random.uniform(-0.55, 0.55));
    block.y[i] = static_cast<float>(random.uniform(-0.45, 0.45));
    block.z[i] = i % 11 == 5 ? 1e-12F : static_cast<float>(random.uniform(0.75, 0.85));
    if (i % 22 == 5) block.x[i] = block.y[i] = 0.0F;
  }
  return block;
}

TEST(PairBlock, GapsAreThoseOfPointByPointOnEveryMachine) {
  cv::Mat memory;
  const RgbdFrame frame = rough_wall(memory);
  for (const PairSearch search : {PairSearch{0.035F, 2}, PairSearch{0.008F, 1}, PairSearch{0.5F, 3}}) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{37}, PairBlock::kSize}) {
      PairBlock readable = points_about(count);
      find_gaps_readably(frame, search, readable);
      simd::with_every_target([&] {
        PairBlock fast = points_about(count);
        find_gaps(frame, search, fast);
        for (std::size_t i = 0; i < count; ++i) {
          EXPECT_EQ(fast.distance_sq[i], readable.distance_sq[i]) << i;
          EXPECT_EQ(fast.gap_x[i], readable.gap_x[i]) << i;
          EXPECT_EQ(fast.gap_y[i], readable.gap_y[i]) << i;
          EXPECT_EQ(fast.gap_z[i], readable.gap_z[i]) << i;
        }
      });
    }
  }
}

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

TEST(PairBlock, SumsAreThoseOfRowByRowOnEveryMachine) {
  Random random(7);
  PairRows rows;
  PairBlock::Values weights;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (float& value : rows[i].values) value = static_cast<float>(random.uniform(-1.0, 1.0));
    weights[i] = static_cast<float>(random.uniform());
  }
  for (const std::size_t count : {std::size_t{0}, std::size_t{5}, rows.size()}) {
    PairSums readable = PairSums::Identity();
    add_products_readably(rows, weights, count, readable);
    simd::with_every_target([&] {
      PairSums fast = PairSums::Identity();
      add_products(rows, weights, count, fast);
      EXPECT_EQ(fast, readable);
    });
  }
}

}  // namespace
}  // namespace houghstream
