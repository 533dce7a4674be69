#include "tools/view/drawing/tiles.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"

namespace houghstream::view {
namespace {

TEST(Tiles, FewerThanARowMakeANarrowImage) {
  const std::vector<cv::Mat> two(2, cv::Mat(20, 30, CV_8UC3, cv::Scalar(255, 255, 255)));
  EXPECT_EQ(tiled(two, 4).size(), cv::Size(64, 20));
  EXPECT_EQ(tiled(two, 1).size(), cv::Size(30, 44));
  EXPECT_EQ(tiled(two, 1).at<cv::Vec3b>(21, 5)[0], 60);
}

TEST(Tiles, NoneAreRefused) {
  EXPECT_THROW(tiled({}, 3), InputError);
}

}  // namespace
}  // namespace houghstream::view
