#include "detector/features/feature_image.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace houghstream {
namespace {

TEST(FeatureImage, TheBorderRepeatsTheNearestInnerPixelInEveryChannel) {
  constexpr int kWidth = 7;
  constexpr int kHeight = 5;
  FeatureImage image(kWidth, kHeight);
  const auto value = [](int x, int y, int channel) { return static_cast<std::uint8_t>(x + 10 * y + 3 * channel); };
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (int c = 0; c < FeatureImage::kChannels; ++c) image.at(x, y)[c] = value(x, y, c);
    }
  }
  image.replicate_border();
  int wrong = 0;
  for (int y = -FeatureImage::kPad; y < kHeight + FeatureImage::kPad; ++y) {
    for (int x = -FeatureImage::kPad; x < kWidth + FeatureImage::kPad; ++x) {
      for (int c = 0; c < FeatureImage::kChannels; ++c) {
        const auto expected = value(std::clamp(x, 0, kWidth - 1), std::clamp(y, 0, kHeight - 1), c);
        wrong += image.at(x, y)[c] != expected ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST(FeatureImage, TheRowStrideLeadsToThePixelBelow) {
  const FeatureImage image(7, 5);
  EXPECT_EQ(image.at(3, 1) + image.row_stride(), image.at(3, 2));
  EXPECT_EQ(image.at(3, 1) + FeatureImage::kChannels, image.at(4, 1));
}

}  // namespace
}  // namespace houghstream
