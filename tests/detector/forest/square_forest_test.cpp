#include "detector/forest/square_forest.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace houghstream {
namespace {

/// Whether a node sends a patch right that sees these two values, which are all of a square's bytes at its two places.
bool goes_right(const SquareNode& node, std::vector<std::uint8_t>& square, const PixelTest& test, int p1, int p2,
                const SquareLayout& layout) {
  const std::size_t centre = static_cast<std::size_t>(layout.reach * layout.row_stride + layout.reach);
  const auto at = [&](int dx, int dy) { return centre + static_cast<std::size_t>(dy * layout.row_stride + dx); };
  square[at(test.dx1, test.dy1)] = static_cast<std::uint8_t>(p1);
  square[at(test.dx2, test.dy2)] = static_cast<std::uint8_t>(p2);
  const int difference = square[node.first >> 8] - square[node.second >> 8];
  const int value = (node.second & SquareNode::kWraps) != 0 ? (difference + 128) & 255 : std::max(0, difference);
  return (value >= static_cast<int>(node.first & 255)) != ((node.second & SquareNode::kInverted) != 0);
}

TEST(SquareForest, ANodeDecidesAsItsTestForAllThresholds) {
  constexpr int kOnePixelPerStep = 256;
  for (const std::uint8_t kind : {PixelTest::kDifference, PixelTest::kWrapping, PixelTest::kAlone}) {
    for (int threshold = -300; threshold <= 300; ++threshold) {
      Forest forest;
      const PixelTest test{2, 1, 3, 1, 0, kind, static_cast<std::int16_t>(threshold)};
      forest.nodes = {{test, -1, -2}};
      forest.roots = {0};
      const SquareForest ready(forest, kOnePixelPerStep, 1);
      std::vector<std::uint8_t> square(ready.layout.size(), 0);
      for (const int p1 : {0, 1, 100, 127, 128, 254, 255}) {
        for (const int p2 : {0, 1, 99, 100, 101, 127, 128, 255}) {
          const std::uint8_t row[] = {0, 0, static_cast<std::uint8_t>(p1), static_cast<std::uint8_t>(p2)};
          // the second row is the first one again
          const bool expected = test_value(test, {row, kOnePixelPerStep, 0, 1}) >= threshold;
          ASSERT_EQ(goes_right(ready.nodes[0], square, test, p1, p2, ready.layout), expected)
              << "kind " << int{kind} << " threshold " << threshold << " pixels " << p1 << " " << p2;
        }
      }
    }
  }
}

}  // namespace
}  // namespace houghstream
