#include "detector/features/feature_tiles.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

std::vector<cv::Rect> all_parts(const FeatureTiles& tiles, int max_length) {
  std::vector<cv::Rect> parts;
  for (int row = 0; row < tiles.rows(); ++row) tiles.list_parts(row, max_length, parts);
  return parts;
}

bool wanted(const FeatureTiles& tiles, cv::Point pixel) {
  for (const cv::Rect& part : all_parts(tiles, 64)) {
    if (part.contains(pixel)) return true;
  }
  return false;
}

TEST(FeatureTiles, NothingIsWantedUntilAPatchIsThere) {
  FeatureTiles tiles;
  tiles.want_all({100, 70});
  tiles.clear({100, 70});
  EXPECT_TRUE(all_parts(tiles, 64).empty());
  tiles.add_patch(40, 40, 0);
  EXPECT_EQ(all_parts(tiles, 64), (std::vector<cv::Rect>{{32, 32, 32, 32}}));
}

TEST(FeatureTiles, AsFarAsAPatchLooksEverythingIsWanted) {
  const cv::Size size(150, 110);
  for (const cv::Point patch : {cv::Point(0, 0), cv::Point(149, 109), cv::Point(63, 64), cv::Point(70, 31)}) {
    for (const int reach : {0, 1, 9, 24}) {
      FeatureTiles tiles;
      tiles.clear(size);
      tiles.add_patch(patch.x, patch.y, reach);
      for (int y = std::max(0, patch.y - reach); y <= std::min(size.height - 1, patch.y + reach); ++y) {
        for (int x = std::max(0, patch.x - reach); x <= std::min(size.width - 1, patch.x + reach); ++x) {
          ASSERT_TRUE(wanted(tiles, {x, y})) << patch << " " << reach << " " << x << " " << y;
        }
      }
    }
  }
}

TEST(FeatureTiles, PartsLieSideBySideAndEndWithTheImage) {
  FeatureTiles tiles;
  tiles.want_all({150, 40});
  const std::vector<cv::Rect> expected{{0, 0, 64, 32}, {64, 0, 64, 32}, {128, 0, 22, 32},
                                       {0, 32, 64, 8}, {64, 32, 64, 8}, {128, 32, 22, 8}};
  EXPECT_EQ(all_parts(tiles, 64), expected);
}

}  // namespace
}  // namespace houghstream
