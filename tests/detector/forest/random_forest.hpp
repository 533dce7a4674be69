#pragma once

#include <cstdint>

#include "detector/features/feature_image.hpp"
#include "detector/forest/forest.hpp"
#include "pipeline/base/random.hpp"

namespace houghstream::chance {

/// Returns random bytes in every plane, in the border and behind the last pixel's planes too.
inline FeatureImage random_image(int width, int height, int pixel_stride, Random& random) {
  FeatureImage image(width, height, pixel_stride);
  for (int y = -FeatureImage::kPad; y < image.height() + FeatureImage::kPad; ++y) {
    std::uint8_t* row = image.at(-FeatureImage::kPad, y);
    for (int i = 0; i < image.row_stride(); ++i) row[i] = static_cast<std::uint8_t>(random.below(256));
  }
  return image;
}

inline PixelTest random_test(int planes, Random& random) {
  constexpr std::uint8_t kKinds[] = {PixelTest::kDifference, PixelTest::kWrapping, PixelTest::kSinglePixel};
  const auto step = [&] {
    return static_cast<std::int8_t>(random.between(-PatchSettings{}.radius, PatchSettings{}.radius));
  };
  PixelTest test;
  test.dx1 = step();
  test.dy1 = step();
  test.dx2 = step();
  test.dy2 = step();
  test.kind = kKinds[random.below(3)];
  test.plane = static_cast<std::uint8_t>(random.uniform() < 0.2 ? planes - 1 : random.below(planes));
  const int middle = test.kind == PixelTest::kSinglePixel ? 128 : 0;
  const int spread = random.uniform() < 0.1 ? 400 : 60;  // some thresholds are out of every difference's reach
  test.threshold = static_cast<std::int16_t>(middle + random.between(-spread, spread));
  return test;
}

/// Returns two grown trees, the second one behind the first, and between them one that is a leaf.
inline Forest random_forest(int planes, Random& random) {
  Forest forest;
  std::int32_t leaves = 0;
  for (const int size : {200, 0, 60}) {
    const auto first = static_cast<std::int32_t>(forest.nodes.size());
    forest.roots.push_back(size > 0 ? first : -1 - leaves++);
    std::int32_t unused = first + 1;
    for (int n = 0; n < size; ++n) {
      TreeNode node{random_test(planes, random), 0, 0};
      for (std::int32_t* child : {&node.left, &node.right}) {
        const bool must_grow = unused == first + n + 1 && child == &node.right;  // else the tree would end here
        const bool grows = unused < first + size && (must_grow || random.uniform() < 0.7);
        *child = grows ? unused++ : -1 - leaves++;
      }
      forest.nodes.push_back(node);
    }
  }
  return forest;
}

}  // namespace houghstream::chance
