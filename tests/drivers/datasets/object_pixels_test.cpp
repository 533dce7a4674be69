#include "drivers/datasets/object_pixels.hpp"

#include <gtest/gtest.h>

#include "tests/test_files.hpp"

namespace houghstream {
namespace {

TEST(ObjectPixels, OnlyThoseOfTheMaskWithDepthCount) {
  RgbdFrame frame = plain_frame();  // without depth at the first pixel
  const cv::Mat mask = box_mask({0, 0, 3, 2});
  frame.colour.at<cv::Vec3b>(1, 2) = {7, 8, 9};
  frame.depth.at<float>(1, 2) = 2.0F;
  EXPECT_EQ(count_depth_pixels(frame.depth, mask), 5);
  const std::vector<ColouredPoint> points = object_points(frame.colour, frame.depth, mask, frame.camera);
  ASSERT_EQ(points.size(), 5U);
  EXPECT_EQ(points.front().position, frame.camera.backproject(1, 0, 1.0)) << "row by row";
  EXPECT_EQ(points.back().position, frame.camera.backproject(2, 1, 2.0));
  EXPECT_EQ(points.back().colour, cv::Vec3b(7, 8, 9));
}

TEST(ObjectPixels, NoMaskOrNoDepthIsNoPoint) {
  RgbdFrame frame = plain_frame();
  EXPECT_EQ(count_depth_pixels(frame.depth, cv::Mat::zeros(48, 64, CV_8UC1)), 0);
  frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(object_points(frame.colour, frame.depth, box_mask({0, 0, 64, 48}), frame.camera).empty());
}

}  // namespace
}  // namespace houghstream
