#include "pose/seen/region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/pose/test_scene.hpp"

namespace houghstream {
namespace {

using namespace test_scene;

/// Returns a wall at 2 m with a 100 x 80 pixel patch at 1 m, whose first pixel is (200,150).
RgbdFrame patch_before_wall() {
  RgbdFrame frame;
  frame.camera = kCamera;
  frame.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(2.0F));
  frame.depth(cv::Rect(200, 150, 100, 80)).setTo(1.0F);
  return frame;
}

Detection patch_detection() {
  Detection detection;
  detection.box_px = cv::Rect2f(200, 150, 100, 80);
  detection.centre_camera = Eigen::Vector3f(-0.1F, -0.1F, 1.02F);
  return detection;
}

const ObjectModel kModel = make_object_model("box", cereal_box(), ModelSettings());

TEST(Region, HoldsTheObjectsDepthAndNotTheWalls) {
  const DepthRegion region = find_region(patch_before_wall(), patch_detection(), kModel, RegionSettings());
  EXPECT_EQ(region.box_px, cv::Rect(185, 138, 130, 104));
  EXPECT_EQ(region.points, 100 * 80);
  EXPECT_LT(region.nearest, 0.85F);
  EXPECT_GT(region.farthest, 1.2F);
  EXPECT_LT(region.farthest, 1.5F);
}

TEST(Region, ColoursAreBroughtIntoTheToneOfTheWholeFrame) {
  RgbdFrame frame = patch_before_wall();
  frame.colour = cv::Mat(480, 640, CV_8UC3, cv::Scalar::all(20));
  frame.colour(cv::Rect(200, 150, 100, 80)).setTo(cv::Scalar::all(60));
  RegionSettings settings;
  const auto lightness = [&] {
    const ObjectObservation observation =
        observe_object(make_frame_context(frame, settings, DepthNoise()), patch_detection(), kModel, settings);
    return observation.colours.lab.at<cv::Vec3b>(50, 50)[0];
  };
  const int dark = lightness();
  settings.tone = {100.0F, 130.0F, 50.0F};
  EXPECT_GT(lightness(), dark + 60) << "140 instead of 60";
}

TEST(Region, PointsAreSpreadOverIt) {
  const RgbdFrame frame = patch_before_wall();
  const DepthRegion region = find_region(frame, patch_detection(), kModel, RegionSettings());
  const std::vector<Eigen::Vector3f> points = region_points(frame, region, 400);
  EXPECT_GT(points.size(), 250U);
  EXPECT_LT(points.size(), 600U);
  for (const Eigen::Vector3f& point : points) {
    EXPECT_EQ(point.z(), 1.0F);
    const Eigen::Vector2d pixel = kCamera.project(point.cast<double>());
    EXPECT_NEAR(pixel.x(), 250.0, 50.0);
    EXPECT_NEAR(pixel.y(), 190.0, 40.0);
  }
}

TEST(Region, MissingDepthIsNoPoint) {
  RgbdFrame frame = patch_before_wall();
  frame.depth(cv::Rect(200, 150, 50, 80)).setTo(std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(find_region(frame, patch_detection(), kModel, RegionSettings()).points, 50 * 80);
}

TEST(Region, BoxesOutsideOrWithAbsurdNumbersAreEmptyAndCutBoxesAreCut) {
  Detection detection = patch_detection();
  for (const cv::Rect2f& box : {cv::Rect2f(-400, 10, 100, 100), cv::Rect2f(700, 10, 50, 50), cv::Rect2f(1e30F, 0, 9, 9),
                                cv::Rect2f(std::nanf(""), 0, 9, 9)}) {
    detection.box_px = box;
    const DepthRegion region = find_region(patch_before_wall(), detection, kModel, RegionSettings());
    EXPECT_EQ(region.points, 0);
    EXPECT_TRUE(region_points(patch_before_wall(), region, 100).empty());
  }
  detection.box_px = cv::Rect2f(-50, -50, 1e9F, 1e9F);
  EXPECT_EQ(find_region(patch_before_wall(), detection, kModel, RegionSettings()).box_px, cv::Rect(0, 0, 640, 480));
}

}  // namespace
}  // namespace houghstream
