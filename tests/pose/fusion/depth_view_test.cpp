#include "pose/fusion/depth_view.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/pose/fusion/turntable_views.hpp"

namespace houghstream::fusion {
namespace {

using test_scene::TurntableScene;

TEST(DepthView, NormalsAreThoseOfTheSurfaceAndLookAtTheCamera) {
  const DepthView view = make_depth_view(turntable_view(TurntableScene{test_scene::cereal_box()}, 2));
  int right = 0;
  int all = 0;
  for (const SurfaceSample& sample : sample_view(view, 500)) {
    EXPECT_LT(sample.normal.dot(sample.point), 0.0);
    const Eigen::Vector3d normal = view.T_camera_object.linear().transpose() * sample.normal;
    right += normal.cwiseAbs().maxCoeff() > 0.999 ? 1 : 0;
    ++all;
  }
  EXPECT_GT(all, 300);
  EXPECT_GT(right, all * 8 / 10) << "all but the points near the edges";
}

TEST(DepthView, SurfaceIsKeptOnTheObjectOnly) {
  const TrainingView training = turntable_view(TurntableScene{test_scene::cereal_box()}, 2);
  const DepthView view = make_depth_view(training);
  const cv::Mat kept = view.depth == view.depth;
  EXPECT_EQ(cv::countNonZero(kept & (training.mask == 0)), 0);
  EXPECT_GT(cv::countNonZero(kept), 0.9 * cv::countNonZero(training.mask));
}

TEST(DepthView, BesideTheMaskIsOutsideWhereTheWallIsSeen) {
  TrainingView training = turntable_view(TurntableScene{test_scene::cereal_box()}, 2);
  const cv::Point hole(130, 140);
  cv::circle(training.mask, hole, 8, cv::Scalar(0), cv::FILLED);
  const DepthView view = make_depth_view(training);
  EXPECT_EQ(view.free_space_mask.at<std::uint8_t>(hole), 255) << "a hole through which the wall is seen";
  EXPECT_EQ(view.free_space_mask.at<std::uint8_t>(2, 2), 255);
  EXPECT_EQ(cv::countNonZero(view.free_space_mask & training.mask), 0);
}

TEST(DepthView, AMaskMadeOfDepthIsFilledToItsHull) {
  TurntableScene scene{test_scene::cereal_box()};
  scene.background = false;
  TrainingView training = turntable_view(scene, 2);
  const cv::Mat whole = training.mask.clone();
  const cv::Rect box = cv::boundingRect(whole);
  const cv::Rect notch(box.x, box.y + box.height / 2, box.width / 2, 12);  // at the outline, as glossy objects have
  training.mask(notch) = 0;
  training.frame.depth(notch) = std::numeric_limits<float>::quiet_NaN();
  const DepthView view = make_depth_view(training);
  EXPECT_EQ(cv::countNonZero(view.free_space_mask & whole), 0);
  EXPECT_EQ(view.free_space_mask.at<std::uint8_t>(2, 2), 255);
}

TEST(DepthView, SpecksOfTheMaskAreDropped) {
  TurntableScene scene{test_scene::cereal_box()};
  scene.background = false;
  TrainingView training = turntable_view(scene, 2);
  const cv::Rect speck(3, 270, 9, 9);
  training.mask(speck) = 255;
  training.frame.depth(speck) = 0.6F;
  const DepthView view = make_depth_view(training);
  EXPECT_EQ(cv::countNonZero(view.depth(speck) == view.depth(speck)), 0);
  EXPECT_EQ(view.free_space_mask.at<std::uint8_t>(274, 7), 255);
}

TEST(DepthView, PixelsOfPointsOutOfSightAreNone) {
  const DepthView view = make_depth_view(turntable_view(TurntableScene{test_scene::cereal_box()}, 0));
  EXPECT_FALSE(view.pixel_of({0.0, 0.0, -0.5}));
  EXPECT_FALSE(view.pixel_of({5.0, 0.0, 0.5}));
  EXPECT_EQ(view.pixel_of(view.camera.backproject(7, 9, 0.5)), cv::Point(7, 9));
}

}  // namespace
}  // namespace houghstream::fusion
