#include "detector/forest/square_planes.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "tests/detector/forest/random_forest.hpp"

namespace houghstream {
namespace {

void expect_pixels(const FeatureImage& image, cv::Rect box, const SquareLayout& layout) {
  PatchSquare square;
  square.left = box.x;
  square.top = box.y;
  square.width = box.width;
  square.height = box.height;
  square.layout = layout;
  std::vector<std::uint8_t> planes(3, 9);
  copy_planes(image, square, planes);
  ASSERT_EQ(planes.size(), layout.size());
  for (int p = 0; p <= layout.planes; ++p) {
    for (int y = 0; y < square.height + 2 * layout.reach; ++y) {
      for (int x = 0; x < square.width + 2 * layout.reach; ++x) {
        const int at = p * layout.plane_stride + y * layout.row_stride + x;
        const std::uint8_t* pixel = image.at(square.left - layout.reach + x, square.top - layout.reach + y);
        const int expected = p < layout.planes ? pixel[p] : 0;
        ASSERT_EQ(planes[static_cast<std::size_t>(at)], expected) << "plane " << p << " at " << x << "," << y;
      }
    }
  }
}

TEST(SquarePlanes, HoldThePixelsOfTheSquareAndAroundIt) {
  Random random(31);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();  // the next call chooses anew
    for (const int count : {32, 96}) {
      const FeatureImage image = chance::random_image(45, 40, count, random);
      expect_pixels(image, {0, 0, 32, 32}, SquareLayout(FeatureImage::kPad, count));
      expect_pixels(image, {32, 32, 13, 8}, SquareLayout(FeatureImage::kPad, count));
      expect_pixels(image, {7, 3, 1, 1}, SquareLayout(0, count));
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
}

}  // namespace
}  // namespace houghstream
