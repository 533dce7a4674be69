#include "detector/features/tile_interleave.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace houghstream {
namespace {

std::uint8_t value(int x, int y, int plane) {
  return static_cast<std::uint8_t>(7 * x + 31 * y + 3 * plane);
}

class TileTurn : public ::testing::TestWithParam<int> {};

TEST_P(TileTurn, ValuesOfAPixelLieSideBySideAndOtherPixelsStay) {
  const cv::Rect part(3, 2, 37, 4);
  const int planes = GetParam();
  TileRows rows;
  rows.reset(part.size(), planes);
  for (int y = 0; y < part.height; ++y) {
    for (int p = 0; p < planes; ++p) {
      for (int x = 0; x < part.width; ++x) rows.row(y, p)[x] = value(x, y, p);
    }
  }
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // the next call selects the target again
    FeatureImage image(50, 8, planes);
    interleave_planes(rows, part, image);
    int wrong = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        const bool inside = part.contains({x, y});
        for (int p = 0; p < planes; ++p) {
          wrong += image.at(x, y)[p] != (inside ? value(x - part.x, y - part.y, p) : 0) ? 1 : 0;
        }
      }
    }
    EXPECT_EQ(wrong, 0) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

INSTANTIATE_TEST_SUITE_P(Planes, TileTurn, ::testing::Values(32, 64, 96));

}  // namespace
}  // namespace houghstream
