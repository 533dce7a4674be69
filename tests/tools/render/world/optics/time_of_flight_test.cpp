#include "tools/render/world/optics/time_of_flight.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace houghstream::world {
namespace {

const cv::Size kTofSize(160, 120);
const TimeOfFlightSettings kTofSettings;

/// Returns a wall at one depth, facing the camera, of matt paint.
SensorView plane_wall(double z, double reflectance = 0.5) {
  return {cv::Mat(kTofSize, CV_32FC1, cv::Scalar(z)), cv::Mat(kTofSize, CV_32FC1, cv::Scalar(1.0)),
          cv::Mat(kTofSize, CV_32FC1, cv::Scalar(reflectance)), cv::Mat(kTofSize, CV_32FC1, cv::Scalar(0.0))};
}

int count_measured(const cv::Mat& depth) {
  return cv::countNonZero(depth == depth);
}

double deviation_at(double z, double reflectance) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(measure_time_of_flight(plane_wall(z, reflectance), kTofSettings, 5), mean, deviation);
  EXPECT_NEAR(mean[0], z, 0.001);
  return deviation[0];
}

TEST(TimeOfFlight, NoiseGrowsWithDistanceAndOnDarkSurfaces) {
  EXPECT_NEAR(deviation_at(1.0, 0.5), 0.0016, 0.0002);
  EXPECT_NEAR(deviation_at(2.0, 0.5), 0.0049, 0.0005);
  EXPECT_NEAR(deviation_at(1.0, 0.1), 0.0061, 0.0006);
  EXPECT_NEAR(deviation_at(1.0, 0.5), time_of_flight_sigma(0.5, kTofSettings), 0.0002);
}

TEST(TimeOfFlight, HasNoDisparityStepsAndNoShadow) {
  const cv::Mat depth = measure_time_of_flight(plane_wall(2.0), kTofSettings, 1);
  const std::set<float> values(depth.begin<float>(), depth.end<float>());
  int neighbours = 0;
  for (auto here = values.begin(), next = std::next(here); next != values.end(); ++here, ++next)
    neighbours += *next - *here < 0.0011F ? 1 : 0;
  EXPECT_GT(neighbours, 20) << "every millimetre about the wall; structured light has steps of 11";
  SensorView near_thing = plane_wall(2.0);
  near_thing.depth.colRange(80, 110).setTo(1.0);
  EXPECT_EQ(count_measured(measure_time_of_flight(near_thing, kTofSettings, 1)), kTofSize.area());
}

TEST(TimeOfFlight, PixelsFlyBetweenTheTwoDepthsOfAnEdge) {
  SensorView view = plane_wall(1.5);
  view.depth.rowRange(60, 120).setTo(1.0);
  const cv::Mat depth = measure_time_of_flight(view, kTofSettings, 1);
  const auto flying = [&](int first, int last) {
    return cv::countNonZero((depth.rowRange(first, last) > 1.03) & (depth.rowRange(first, last) < 1.47));
  };
  EXPECT_NEAR(flying(59, 61), 2 * 160 * kTofSettings.flying_fraction * 0.88, 40);
  EXPECT_EQ(flying(0, 59), 0);
  EXPECT_EQ(flying(61, 120), 0);
  // The near wall returns (1.5 / 1)^2 as much light: pixels lie nearer to it.
  double sum = 0.0;
  int count = 0;
  for (const float z : cv::Mat_<float>(depth.rowRange(59, 61))) {
    if (z < 1.03F || z > 1.47F) continue;
    sum += z;
    ++count;
  }
  EXPECT_LT(sum / count, 1.23);
}

/// Returns two planes that meet in the middle column, `slope` metres a pixel away from the camera (a corner) or towards
/// it.
double bias_in_the_middle(double slope) {
  SensorView view = plane_wall(1.0);
  for (int x = 0; x < kTofSize.width; ++x) view.depth.col(x).setTo(1.0 - slope * std::abs(x - 80));
  const cv::Mat measured = measure_time_of_flight(view, kTofSettings, 3);
  return cv::mean(measured.col(80) - view.depth.col(80))[0];
}

TEST(TimeOfFlight, AConcaveCornerSeemsFartherAway) {
  EXPECT_GT(bias_in_the_middle(0.002), 0.004);
  EXPECT_LT(bias_in_the_middle(0.002), 0.012);
  EXPECT_LT(std::abs(bias_in_the_middle(-0.002)), 0.001) << "an edge that sticks out lights nothing";
  SensorView slope = plane_wall(1.0);
  for (int x = 0; x < kTofSize.width; ++x) slope.depth.col(x).setTo(1.0 + 0.002 * (x - 80));
  const cv::Mat measured = measure_time_of_flight(slope, kTofSettings, 3);
  EXPECT_LT(std::abs(cv::mean(measured - slope.depth)[0]), 0.0005) << "nor does a wall that leans";
}

TEST(TimeOfFlight, WhatReturnsTooLittleOrIsOutOfRangeGivesNothing) {
  const double nowhere = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(count_measured(measure_time_of_flight(plane_wall(1.0, 0.002), kTofSettings, 1)), 0);
  EXPECT_EQ(count_measured(measure_time_of_flight(plane_wall(0.25), kTofSettings, 1)), 0);
  EXPECT_EQ(count_measured(measure_time_of_flight(plane_wall(5.5), kTofSettings, 1)), 0);
  EXPECT_EQ(count_measured(measure_time_of_flight(plane_wall(nowhere), kTofSettings, 1)), 0);
  SensorView grazing = plane_wall(1.0);
  grazing.cos_incidence.setTo(0.004);
  EXPECT_EQ(count_measured(measure_time_of_flight(grazing, kTofSettings, 1)), 0);
}

TEST(TimeOfFlight, SameSeedSameNoise) {
  const cv::Mat first = measure_time_of_flight(plane_wall(2.0), kTofSettings, 9);
  EXPECT_EQ(cv::norm(first, measure_time_of_flight(plane_wall(2.0), kTofSettings, 9), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(first, measure_time_of_flight(plane_wall(2.0), kTofSettings, 10), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace houghstream::world
