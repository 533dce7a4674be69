#include "detector/forest/square_forest.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace houghstream {
namespace {

constexpr int kSide = 7;  // steps of a patch of radius 3

/// Whether a node sends a patch right that sees these two values at its test's places.
bool goes_right(const SquareNode& node, const PixelTest& test, int p1, int p2) {
  const auto value_at = [&](std::uint32_t word) {
    const std::uint32_t step = word >> SquareNode::kStepShift & SquareNode::kStepMask;
    EXPECT_EQ(word >> SquareNode::kPlaneShift, test.plane);
    if (step == step_number(test.dx1, test.dy1, kSide / 2)) return p1;
    EXPECT_EQ(step, step_number(test.dx2, test.dy2, kSide / 2));
    return p2;
  };
  const bool alone = (node.second & SquareNode::kAlone) != 0;
  const int difference = value_at(node.first) - (alone ? 0 : value_at(node.second));
  const int value = (node.second & SquareNode::kWraps) != 0 ? (difference + 128) & 255 : std::max(0, difference);
  return (value >= static_cast<int>(node.first & 255)) != ((node.second & SquareNode::kInverted) != 0);
}

TEST(SquareForest, ANodeDecidesAsItsTestForAllThresholds) {
  constexpr int kOnePixelPerStep = 256;
  for (const std::uint8_t kind : {PixelTest::kDifference, PixelTest::kWrapping, PixelTest::kAlone}) {
    for (int threshold = -300; threshold <= 300; ++threshold) {
      Forest forest;
      const PixelTest test{2, 1, 3, 1, 254, kind, static_cast<std::int16_t>(threshold)};
      forest.patch.radius = kSide / 2;
      forest.nodes = {{test, -1, -2}};
      forest.roots = {0};
      const SquareForest ready(forest);
      for (const int p1 : {0, 1, 100, 127, 128, 254, 255}) {
        for (const int p2 : {0, 1, 99, 100, 101, 127, 128, 255}) {
          std::uint8_t pixels[258] = {};
          pixels[2 + 254] = static_cast<std::uint8_t>(p1);
          pixels[3 + 254] = static_cast<std::uint8_t>(p2);
          const bool expected = test_value(test, {pixels, kOnePixelPerStep, 0, 1}) >= threshold;  // rows are alike
          ASSERT_EQ(goes_right(ready.nodes[0], test, p1, p2), expected)
              << "kind " << int{kind} << " threshold " << threshold << " pixels " << p1 << " " << p2;
        }
      }
    }
  }
}

TEST(SquareForest, NumbersTheStepsOfTheLargestPatch) {
  constexpr int kRadius = 127;
  EXPECT_EQ(step_number(-kRadius, -kRadius, kRadius), 0U);
  EXPECT_EQ(step_number(-kRadius + 1, -kRadius, kRadius), 1U);
  EXPECT_EQ(step_number(kRadius, kRadius, kRadius), 255U * 255U - 1U);
  EXPECT_LE(step_number(kRadius, kRadius, kRadius), SquareNode::kStepMask);
}

}  // namespace
}  // namespace houghstream
