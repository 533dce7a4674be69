#include "tools/view/drawing/frame_view.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "pipeline/base/no_value.hpp"

namespace houghstream::view {
namespace {

ViewedFrame small_frame() {
  ViewedFrame viewed;
  viewed.frame.id.utime = 5;
  viewed.frame.colour = cv::Mat(121, 161, CV_8UC3, cv::Scalar(1, 2, 3));
  viewed.frame.depth = cv::Mat(121, 161, CV_32FC1, cv::Scalar(1.0));
  viewed.frame.camera = Camera{161, 121, 150, 150, 80, 60};
  viewed.detections.frame.utime = 5;
  return viewed;
}

TEST(FrameView, DepthIsWarmNearColdFarAndBlackWhereMissing) {
  const cv::Mat depth = (cv::Mat_<float>(1, 3) << 0.6F, 3.2F, kNoValue);
  const cv::Mat image = colour_depth(depth, 0.4F, 3.5F);
  const auto& near = image.at<cv::Vec3b>(0, 0);
  const auto& far = image.at<cv::Vec3b>(0, 1);
  EXPECT_GT(near[2], near[0]);  // more red than blue
  EXPECT_GT(far[0], far[2]);
  EXPECT_EQ(image.at<cv::Vec3b>(0, 2), cv::Vec3b(0, 0, 0));
}

TEST(FrameView, ImageHoldsOverlayDepthAndPanelAndIsEven) {
  const cv::Mat with_depth = draw_frame_view(small_frame(), {}, {});
  EXPECT_EQ(with_depth.cols, 322);
  EXPECT_EQ(with_depth.rows % 2, 0);
  EXPECT_GT(with_depth.rows, 121 + 100);
  EXPECT_EQ(with_depth.at<cv::Vec3b>(60, 60), cv::Vec3b(1, 2, 3));
  FrameViewSettings without;
  without.show_depth = false;
  EXPECT_EQ(draw_frame_view(small_frame(), {}, without).cols, 162);
}

TEST(FrameView, ThreeDStandsInThePlaceOfDepth) {
  FrameViewSettings settings;
  const cv::Mat with_depth = draw_frame_view(small_frame(), {}, settings);
  settings.show_3d = true;
  const cv::Mat with_3d = draw_frame_view(small_frame(), {}, settings);
  ASSERT_EQ(with_3d.size(), with_depth.size());
  const cv::Rect left(0, 0, 161, 121);
  const cv::Rect right(161, 0, 161, 121);
  EXPECT_EQ(cv::norm(with_3d(left), with_depth(left), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(with_3d(right), with_depth(right), cv::NORM_INF), 0.0);
  settings.show_depth = false;
  EXPECT_EQ(draw_frame_view(small_frame(), {}, settings).cols, with_3d.cols);
}

TEST(FrameView, WeakDetectionsAreLeftOutWithTheirPoses) {
  ViewedFrame viewed;
  viewed.detections.detections.resize(3);
  viewed.detections.detections[0].score = 0.9F;
  viewed.detections.detections[1].score = 0.1F;
  viewed.detections.detections[2].score = 0.4F;
  viewed.poses.emplace();
  viewed.poses->poses.resize(3);
  for (int i = 0; i < 3; ++i) viewed.poses->poses[static_cast<std::size_t>(i)].detection_index = i;
  const ViewedFrame strong = without_weak(viewed, 0.3F);
  ASSERT_EQ(strong.detections.detections.size(), 2U);
  EXPECT_EQ(strong.detections.detections[1].score, 0.4F);
  ASSERT_EQ(strong.poses->poses.size(), 2U);
  EXPECT_EQ(strong.poses->poses[1].detection_index, 1);
}

TEST(FrameView, CandidatesAreDrawnWhereAPoseConfirmsThem) {
  ViewedFrame viewed;
  viewed.detections.detections.resize(3);
  for (const std::size_t i : {1, 2}) viewed.detections.detections[i].reported = false;
  EXPECT_EQ(without_weak(viewed, 0.0F).detections.detections.size(), 1U);
  viewed.poses.emplace();
  viewed.poses->poses.resize(1);
  viewed.poses->poses[0].detection_index = 2;
  viewed.poses->poses[0].status = PoseStatus::kValid;
  const ViewedFrame shown = without_weak(viewed, 0.0F);
  ASSERT_EQ(shown.detections.detections.size(), 2U);
  EXPECT_EQ(shown.poses->poses.at(0).detection_index, 1);
  EXPECT_EQ(shown.weak, 1U);
}

}  // namespace
}  // namespace houghstream::view
