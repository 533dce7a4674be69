#include "detector/features/picture_memory.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(PictureMemory, ASmallerPictureTakesTheMemoryOfALargerOne) {
  PictureMemory memory;
  cv::Mat large = memory.picture({40, 30}, CV_8UC3);
  ASSERT_EQ(large.size(), cv::Size(40, 30));
  ASSERT_EQ(large.type(), CV_8UC3);
  large.setTo(cv::Scalar(1, 2, 3));
  const uchar* const begin = large.data;
  const cv::Mat small = memory.picture({7, 5}, CV_32FC1);
  EXPECT_EQ(small.size(), cv::Size(7, 5));
  EXPECT_EQ(small.type(), CV_32FC1);
  EXPECT_EQ(small.data, begin);
  EXPECT_TRUE(small.isContinuous());
  EXPECT_EQ(memory.picture({40, 30}, CV_8UC3).data, begin);
}

TEST(PictureMemory, Grows) {
  PictureMemory memory;
  memory.picture({7, 5}, CV_8UC1);
  cv::Mat large = memory.picture({400, 300}, CV_8UC1);
  large.setTo(9);
  EXPECT_EQ(cv::countNonZero(large), 400 * 300);
}

}  // namespace
}  // namespace houghstream
