#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>

#include "detector/training/augmentation/camera_randomisation.hpp"

namespace houghstream::training {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
const Camera kView{160, 120, 500.0, 500.0, 79.5, 59.5};
const cv::Rect kNear(60, 40, 40, 40);

/// Returns the depth of a near square in the middle of a wall, with a hole at the left.
cv::Mat near_square() {
  cv::Mat depth(kView.height, kView.width, CV_32FC1, cv::Scalar(1.2));
  depth(kNear) = 0.8;
  depth.colRange(0, 12) = kNone;
  return depth;
}

cv::Mat wall(double z) {
  return cv::Mat(kView.height, kView.width, CV_32FC1, cv::Scalar(z));
}

cv::Mat measured(const DepthVariation& camera, const cv::Mat& depth, const cv::Mat& colour = cv::Mat()) {
  Random random(1);
  cv::Mat out = depth.clone();
  apply_depth({{}, camera}, kView, out, random, colour);
  return out;
}

cv::Mat holes(const cv::Mat& depth) {
  return ~(depth == depth);
}

/// Returns the pixels within `reach_px` of the square's outline.
cv::Mat outline(int reach_px) {
  cv::Mat band = cv::Mat::zeros(kView.height, kView.width, CV_8UC1);
  band(kNear + cv::Point(-reach_px, -reach_px) + cv::Size(2 * reach_px, 2 * reach_px)).setTo(255);
  band(kNear + cv::Point(reach_px, reach_px) - cv::Size(2 * reach_px, 2 * reach_px)).setTo(0);
  return band;
}

double deviation(const cv::Mat& depth) {
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(depth, mean, sigma);
  return sigma[0];
}

TEST(CameraDepth, HolesNeverFillUp) {
  const cv::Mat before = near_square();
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    CameraRandomisation camera = sample_camera(1.0, random);
    camera.depth.offset_px = {0, 0};
    cv::Mat after = before.clone();
    apply_depth(camera, kView, after, random);
    EXPECT_EQ(cv::countNonZero(holes(before) & ~holes(after)), 0) << seed;
    double minimum = 0.0;
    double maximum = 0.0;
    cv::minMaxLoc(after, &minimum, &maximum, nullptr, nullptr, ~holes(after));
    EXPECT_GT(minimum, 0.7) << seed;
    EXPECT_LT(maximum, 1.4) << seed;
  }
}

TEST(CameraDepth, EdgeLossMakesHolesAtEdgesOnlyAndAsManyAsAsked) {
  DepthVariation camera;
  camera.edge_loss = 0.5;
  const cv::Mat before = near_square();
  const cv::Mat lost = holes(measured(camera, before)) & ~holes(before);
  EXPECT_EQ(cv::countNonZero(lost & ~outline(1)), 0);
  EXPECT_NEAR(cv::countNonZero(lost), 0.5 * cv::countNonZero(outline(1)), 0.15 * cv::countNonZero(outline(1)));
}

TEST(CameraDepth, TheProjectorsShadowLiesOnOneSideOfWhatIsNear) {
  const cv::Mat before = near_square();
  for (const double shadow_m : {0.075, -0.075}) {
    DepthVariation camera;
    camera.shadow_m = shadow_m;
    const cv::Mat lost = holes(measured(camera, before)) & ~holes(before);
    const cv::Rect box = cv::boundingRect(lost);
    const double width = 500.0 * 0.075 * (1.0 / 0.8 - 1.0 / 1.2);
    EXPECT_NEAR(box.width, width, 2.5);
    EXPECT_EQ(box.height, kNear.height);
    if (shadow_m > 0.0) {
      EXPECT_EQ(box.br().x, kNear.x) << "the projector is to the right: it does not see what lies to the left";
    } else {
      EXPECT_EQ(box.x, kNear.br().x);
    }
  }
}

TEST(CameraDepth, NearSurfacesGrowAndDepthMovesByWholePixels) {
  DepthVariation camera;
  camera.grown_px = {2, 1};
  camera.offset_px = {3, -1};
  const cv::Mat after = measured(camera, near_square());
  EXPECT_EQ(cv::boundingRect(after == 0.8F), cv::Rect(60 - 2 + 3, 40 - 1 - 1, 44, 42));
  EXPECT_EQ(cv::countNonZero(after == 0.8F) + cv::countNonZero(after == 1.2F), cv::countNonZero(after == after));
}

TEST(CameraDepth, FlyingPixelsLieBetweenTheSurfacesOfAnEdge) {
  DepthVariation camera;
  camera.kind = DepthKind::kTimeOfFlight;
  camera.flying_pixel_fraction = 0.5;
  const cv::Mat after = measured(camera, near_square());
  const cv::Mat between = (after > 0.801F) & (after < 1.199F);
  EXPECT_NEAR(cv::countNonZero(between), 0.5 * cv::countNonZero(outline(1)), 0.1 * cv::countNonZero(outline(1)));
  EXPECT_EQ(cv::countNonZero(between & ~outline(1)), 0);
}

TEST(CameraDepth, OutlinesWaverByAboutTheirDeviation) {
  DepthVariation camera;
  camera.jitter_px = 1.0;
  const cv::Mat after = measured(camera, near_square());
  cv::Mat changed = (after != near_square()) & ~holes(near_square());
  EXPECT_GT(cv::countNonZero(changed & outline(1)), 0.2 * cv::countNonZero(outline(1)));
  EXPECT_EQ(cv::countNonZero(changed & ~outline(2)), 0);
}

TEST(CameraDepth, StructuredNoiseIsNguyensTimesTheFactor) {
  for (const double z : {0.6, 1.0, 2.0}) {
    DepthVariation camera;
    camera.noise = 1.0;
    const double expected = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    EXPECT_NEAR(deviation(measured(camera, wall(z))), expected, 0.1 * expected) << z;
    camera.noise = 0.5;
    EXPECT_NEAR(deviation(measured(camera, wall(z))), 0.5 * expected, 0.06 * expected) << z;
  }
}

TEST(CameraDepth, DisparityStepsAreKhoshelhams) {
  DepthVariation camera;
  camera.disparity_step_px = 0.125;
  cv::Mat ramp(kView.height, kView.width, CV_32FC1);
  for (int x = 0; x < ramp.cols; ++x) ramp.col(x) = 1.0 + 0.0005 * x;
  const cv::Mat after = measured(camera, ramp);
  std::set<float> depths;
  for (int x = 0; x < ramp.cols; ++x) depths.insert(after.at<float>(50, x));
  EXPECT_NEAR(static_cast<double>(depths.size()), 0.08 / (2.85e-3 * 1.04 * 1.04) + 1, 2.0) << "2.85 mm apart at 1 m";
  EXPECT_LT(cv::norm(after, ramp, cv::NORM_INF), 0.0018);
}

TEST(CameraDepth, TimeOfFlightIsNoisierOnWhatIsDark) {
  DepthVariation camera;
  camera.kind = DepthKind::kTimeOfFlight;
  camera.noise_floor = 0.001;
  camera.noise_light = 0.0006;
  cv::Mat colour(kView.height, kView.width, CV_8UC3, cv::Scalar::all(200));
  colour.colRange(80, 160).setTo(cv::Scalar::all(60));
  const cv::Mat after = measured(camera, wall(1.0), colour);
  const double bright = deviation(after.colRange(0, 80));
  const double dark = deviation(after.colRange(80, 160));
  EXPECT_NEAR(bright, 0.0014, 0.0003);
  EXPECT_GT(dark, 4.0 * bright);
  camera.noise_light = camera.noise_floor = 0.0;
  camera.dark_bias = 0.005;
  const cv::Mat biased = measured(camera, wall(1.0), colour);
  EXPECT_NEAR(biased.at<float>(5, 5), 1.0F, 1e-6);
  EXPECT_NEAR(biased.at<float>(5, 100), 1.004F, 0.001);
}

TEST(CameraDepth, WigglesComeAndGoWithDistance) {
  DepthVariation camera;
  camera.kind = DepthKind::kTimeOfFlight;
  camera.wiggle = 0.004;
  camera.wiggle_wave = 1.0;
  EXPECT_NEAR(measured(camera, wall(1.25)).at<float>(9, 9), 1.254, 1e-4);
  EXPECT_NEAR(measured(camera, wall(1.75)).at<float>(9, 9), 1.746, 1e-4);
}

TEST(CameraDepth, SmoothingTakesNoiseAndKeepsEdges) {
  DepthVariation noisy;
  noisy.noise = 1.0;
  const cv::Mat before = measured(noisy, near_square());
  for (const DepthSmoothing smoothing : {DepthSmoothing::kMedian, DepthSmoothing::kBilateral}) {
    for (const int window : {3, 5}) {
      DepthVariation camera = noisy;
      camera.smoothing = smoothing;
      camera.smoothing_px = window;
      const cv::Mat after = measured(camera, near_square());
      const cv::Rect inside = kNear + cv::Point(4, 4) - cv::Size(8, 8);
      EXPECT_LT(deviation(after(inside)), deviation(before(inside)));
      EXPECT_EQ(cv::countNonZero((after > 0.83F) & (after < 1.17F)), 0) << "nothing between the surfaces";
      EXPECT_EQ(cv::countNonZero(after < 0.75F), 0) << "holes lend nothing";
    }
  }
}

TEST(CameraDepth, WhatSlantsOrIsDarkIsLost) {
  DepthVariation camera;
  camera.min_cosine = 0.3;
  cv::Mat slant = wall(1.0);
  for (int x = 80; x < 160; ++x) slant.col(x) = 1.0 + 5.0 / 500.0 * (x - 80);  // 79 degrees
  const cv::Mat steep = holes(measured(camera, slant));
  EXPECT_EQ(cv::countNonZero(steep.colRange(0, 76)), 0);
  EXPECT_GT(cv::countNonZero(steep.colRange(84, 100)), 0.8 * 16 * kView.height);

  DepthVariation weak;
  weak.min_signal = 0.03;
  cv::Mat colour(kView.height, kView.width, CV_8UC3, cv::Scalar::all(160));
  colour.colRange(80, 160).setTo(cv::Scalar::all(20));
  const cv::Mat dark = holes(measured(weak, wall(1.0), colour));
  EXPECT_EQ(cv::countNonZero(dark.colRange(0, 80)), 0);
  EXPECT_GT(cv::countNonZero(dark.colRange(80, 160)), 0.9 * 80 * kView.height);
  EXPECT_EQ(cv::countNonZero(holes(measured(weak, wall(1.0)))), 0) << "without colour nothing is dark";
}

TEST(CameraDepth, ScaleIsScale) {
  DepthVariation camera;
  camera.scale = 1.01;
  EXPECT_NEAR(measured(camera, wall(2.0)).at<float>(7, 7), 2.02, 1e-5);
}

}  // namespace
}  // namespace houghstream::training
