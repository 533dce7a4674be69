#include "detector/features/image_buffer.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(ImageBuffer, ASmallerImageTakesTheMemoryOfALargerOne) {
  ImageBuffer memory;
  cv::Mat large = memory.image({40, 30}, CV_8UC3);
  ASSERT_EQ(large.size(), cv::Size(40, 30));
  ASSERT_EQ(large.type(), CV_8UC3);
  large.setTo(cv::Scalar(1, 2, 3));
  const uchar* const begin = large.data;
  const cv::Mat small = memory.image({7, 5}, CV_32FC1);
  EXPECT_EQ(small.size(), cv::Size(7, 5));
  EXPECT_EQ(small.type(), CV_32FC1);
  EXPECT_EQ(small.data, begin);
  EXPECT_TRUE(small.isContinuous());
  EXPECT_EQ(memory.image({40, 30}, CV_8UC3).data, begin);
}

TEST(ImageBuffer, Grows) {
  ImageBuffer memory;
  memory.image({7, 5}, CV_8UC1);
  cv::Mat large = memory.image({400, 300}, CV_8UC1);
  large.setTo(9);
  EXPECT_EQ(cv::countNonZero(large), 400 * 300);
}

}  // namespace
}  // namespace houghstream
