#include "pose/baseline/reference_pair_block.hpp"

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

TEST(ReferencePairBlock, GapsAreThoseOfPointByPointOnEveryMachine) {
  cv::Mat memory;
  const RgbdFrame frame = rough_wall(memory);
  for (const PairSearch search : {PairSearch{0.035F, 2}, PairSearch{0.008F, 1}, PairSearch{0.5F, 3}}) {
    for (const std::size_t count : {std::size_t{1}, std::size_t{37}, PairBlock::kSize}) {
      PairBlock expected = points_about(count);
      reference_find_gaps(frame, search, expected);
      simd::with_every_target([&] {
        PairBlock fast = points_about(count);
        find_gaps(frame, search, fast);
        for (std::size_t i = 0; i < count; ++i) {
          EXPECT_EQ(fast.distance_sq[i], expected.distance_sq[i]) << i;
          EXPECT_EQ(fast.gap_x[i], expected.gap_x[i]) << i;
          EXPECT_EQ(fast.gap_y[i], expected.gap_y[i]) << i;
          EXPECT_EQ(fast.gap_z[i], expected.gap_z[i]) << i;
        }
      });
    }
  }
}

TEST(ReferencePairBlock, SumsAreThoseOfRowByRowOnEveryMachine) {
  Random random(7);
  PairRows rows;
  PairBlock::Values weights;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (float& value : rows[i].values) value = static_cast<float>(random.uniform(-1.0, 1.0));
    weights[i] = static_cast<float>(random.uniform());
  }
  for (const std::size_t count : {std::size_t{0}, std::size_t{5}, rows.size()}) {
    PairSums expected = PairSums::Identity();
    reference_add_products(rows, weights, count, expected);
    simd::with_every_target([&] {
      PairSums fast = PairSums::Identity();
      add_products(rows, weights, count, fast);
      EXPECT_EQ(fast, expected);
    });
  }
}

}  // namespace
}  // namespace houghstream
