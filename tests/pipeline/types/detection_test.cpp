#include "pipeline/types/detection.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(BoxIou, IsTheSharedAreaOverTheJointOne) {
  const cv::Rect2f box(10.0F, 20.0F, 4.0F, 2.0F);
  EXPECT_EQ(box_iou(box, box), 1.0F);
  EXPECT_EQ(box_iou(box, {12.0F, 20.0F, 4.0F, 2.0F}), 4.0F / 12.0F);
  EXPECT_EQ(box_iou({11.0F, 20.0F, 2.0F, 1.0F}, box), 0.25F) << "one within the other";
}

TEST(BoxIou, OfBoxesThatDoNotMeetOrAreEmptyIsNone) {
  const cv::Rect2f box(10.0F, 20.0F, 4.0F, 2.0F);
  EXPECT_EQ(box_iou(box, {14.0F, 20.0F, 4.0F, 2.0F}), 0.0F) << "they touch";
  EXPECT_EQ(box_iou(box, {11.0F, 21.0F, 0.0F, 0.0F}), 0.0F);
  EXPECT_EQ(box_iou({}, {}), 0.0F) << "no division by zero";
}

}  // namespace
}  // namespace houghstream
