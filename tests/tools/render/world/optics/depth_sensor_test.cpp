#include "tools/render/world/optics/depth_sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace houghstream::world {
namespace {

const Camera kCamera{160, 120, 525.0, 525.0, 79.5, 59.5};
const cv::Size kSize(160, 120);
const DepthSensorSettings kSettings;

// Returns a wall at one depth, facing the camera, of a bright matt paint.
SensorView wall(double z) {
  return {cv::Mat(kSize, CV_32FC1, cv::Scalar(z)), cv::Mat(kSize, CV_32FC1, cv::Scalar(1.0)),
          cv::Mat(kSize, CV_32FC1, cv::Scalar(0.5)), cv::Mat(kSize, CV_32FC1, cv::Scalar(0.0))};
}

int count_valid(const cv::Mat& depth) {
  return cv::countNonZero(depth == depth);
}

TEST(DepthSensor, DepthStepsAreThoseOfKhoshelhamAndElberink) {
  EXPECT_NEAR(depth_step(1.0, kSettings), 2.85e-3, 0.05e-3);
  EXPECT_NEAR(depth_step(5.0, kSettings), 0.07, 0.003);
  // All measured values lie on that grid: neighbouring ones at 2 m are 11.5 mm apart, give or take the rounding to 1
  // mm.
  const cv::Mat depth = measure_depth(wall(2.0), kCamera, kSettings, 1);
  const std::set<float> values(depth.begin<float>(), depth.end<float>());
  ASSERT_GT(values.size(), 3U);
  for (auto here = values.begin(), next = std::next(here); next != values.end(); ++here, ++next)
    EXPECT_NEAR(*next - *here, depth_step(*here, kSettings), 0.0018);
}

TEST(DepthSensor, NoiseIsThatOfNguyenAtOneAndTwoMetres) {
  EXPECT_NEAR(axial_sigma(1.0, 1.0), 0.001884, 1e-6);
  EXPECT_NEAR(axial_sigma(2.0, 1.0), 0.006064, 1e-6);
  for (const double z : {1.0, 2.0}) {
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(measure_depth(wall(z), kCamera, kSettings, 5), mean, deviation);
    EXPECT_NEAR(mean[0], z, 0.05 * axial_sigma(z, 1.0) + 0.001);
    EXPECT_NEAR(deviation[0], axial_sigma(z, 1.0), 0.1 * axial_sigma(z, 1.0));
  }
}

TEST(DepthSensor, ShadowFallsToTheLeftOfANearThing) {
  cv::Mat depth(kSize, CV_32FC1, cv::Scalar(2.0));
  depth.colRange(80, 110).setTo(1.0);
  const cv::Mat shadow = infrared_shadow(depth, kCamera, 0.075);
  // The shadow's width is f b (1/1 - 1/2) = 19.7 px.
  EXPECT_EQ(shadow.at<std::uint8_t>(60, 79), 255);
  EXPECT_EQ(shadow.at<std::uint8_t>(60, 62), 255);
  EXPECT_EQ(shadow.at<std::uint8_t>(60, 58), 0);
  EXPECT_EQ(cv::countNonZero(shadow.colRange(80, 160)), 0);
}

TEST(DepthSensor, DarkGrazingAndShinySurfacesGiveHoles) {
  const int all = kSize.area();
  EXPECT_EQ(count_valid(measure_depth(wall(1.0), kCamera, kSettings, 1)), all);
  SensorView dark = wall(2.5);
  dark.reflectance.setTo(0.008);
  EXPECT_LT(count_valid(measure_depth(dark, kCamera, kSettings, 1)), all / 10);
  SensorView grazing = wall(1.0);
  grazing.cos_incidence.setTo(0.05);
  EXPECT_LT(count_valid(measure_depth(grazing, kCamera, kSettings, 1)), all / 10);
  SensorView shiny = wall(1.0);
  shiny.specular.setTo(0.45);
  EXPECT_LT(count_valid(measure_depth(shiny, kCamera, kSettings, 1)), all / 10);
}

TEST(DepthSensor, EdgesLosePixels) {
  SensorView view = wall(1.5);
  view.depth.rowRange(60, 120).setTo(1.0);
  const cv::Mat depth = measure_depth(view, kCamera, kSettings, 1);
  EXPECT_LT(count_valid(depth.rowRange(59, 61)), 2 * 160 * 0.85);
  EXPECT_EQ(count_valid(depth.rowRange(0, 50)), 50 * 160);
}

TEST(DepthSensor, NothingNearerOrFartherThanItsRange) {
  EXPECT_EQ(count_valid(measure_depth(wall(0.3), kCamera, kSettings, 1)), 0);
  EXPECT_EQ(count_valid(measure_depth(wall(5.5), kCamera, kSettings, 1)), 0);
  EXPECT_EQ(count_valid(measure_depth(wall(std::numeric_limits<double>::quiet_NaN()), kCamera, kSettings, 1)), 0);
}

TEST(DepthSensor, SameSeedSameNoise) {
  const cv::Mat first = measure_depth(wall(2.0), kCamera, kSettings, 9);
  EXPECT_EQ(cv::norm(first, measure_depth(wall(2.0), kCamera, kSettings, 9), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(first, measure_depth(wall(2.0), kCamera, kSettings, 10), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace houghstream::world
