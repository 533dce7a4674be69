#include "detector/features/feature_image.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace houghstream {
namespace {

TEST(FeatureImage, TheBorderRepeatsTheNearestInnerPixelInEveryPlane) {
  constexpr int kWidth = 7;
  constexpr int kHeight = 5;
  constexpr int kStride = 32;
  FeatureImage image(kWidth, kHeight, kStride);
  const auto value = [](int x, int y, int plane) { return static_cast<std::uint8_t>(x + 10 * y + 3 * plane); };
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < kStride; ++c) image.at(x, y)[c] = value(x, y, c);
    }
  }
  image.replicate_border();
  int wrong = 0;
  for (int y = -FeatureImage::kPad; y < kHeight + FeatureImage::kPad; ++y) {
    for (int x = -FeatureImage::kPad; x < kWidth + FeatureImage::kPad; ++x) {
      for (int c = 0; c < kStride; ++c) {
        const auto expected = value(std::clamp(x, 0, kWidth - 1), std::clamp(y, 0, kHeight - 1), c);
        wrong += image.at(x, y)[c] != expected ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST(FeatureImage, TheRowStrideLeadsToThePixelBelow) {
  const FeatureImage image(7, 5, 96);
  EXPECT_EQ(image.at(3, 1) + image.row_stride(), image.at(3, 2));
  EXPECT_EQ(image.at(3, 1) + 96, image.at(4, 1));
}

}  // namespace
}  // namespace houghstream
