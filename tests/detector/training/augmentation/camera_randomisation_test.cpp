#include "detector/training/augmentation/camera_randomisation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/detector/toy_data.hpp"

namespace houghstream::training {
namespace {

constexpr int kSeeds = 60;

CameraRandomisation camera(double strength, std::uint64_t seed) {
  Random random(seed);
  return sample_camera(strength, random);
}

TEST(CameraRandomisation, StrengthZeroChangesNothing) {
  const RgbdFrame room = toy::background(3);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const CameraRandomisation none = sample_camera(0.0, random);
    cv::Mat colour = room.colour.clone();
    cv::Mat depth = room.depth.clone();
    apply_colour(none, colour, random);
    apply_depth(none, room.camera, depth, random, room.colour);
    EXPECT_EQ(cv::norm(colour, room.colour, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::countNonZero(depth == room.depth), cv::countNonZero(room.depth == room.depth));
  }
}

TEST(CameraRandomisation, TheSameSeedIsTheSameCameraAndTakesTheSameImage) {
  const RgbdFrame room = toy::background(3);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    cv::Mat colours[2];
    cv::Mat depths[2];
    for (int i = 0; i < 2; ++i) {
      Random random(seed);
      const CameraRandomisation drawn = sample_camera(1.0, random);
      colours[i] = room.colour.clone();
      depths[i] = room.depth.clone();
      apply_colour(drawn, colours[i], random);
      apply_depth(drawn, room.camera, depths[i], random, room.colour);
    }
    EXPECT_EQ(cv::norm(colours[0], colours[1], cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::countNonZero(depths[0] == depths[1]), cv::countNonZero(depths[0] == depths[0]));
    EXPECT_EQ(cv::countNonZero(depths[0] == depths[0]), cv::countNonZero(depths[1] == depths[1]));
    EXPECT_GT(cv::norm(colours[0], room.colour, cv::NORM_INF), 0.0);
  }
}

TEST(CameraRandomisation, DrawnCamerasStayWithinTheirRangesAndReachThem) {
  double min_red = 10.0;
  double max_red = 0.0;
  std::set<int> offsets;
  std::set<int> growths;
  std::set<int> mosaics;
  int compressed = 0;
  int time_of_flight = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const CameraRandomisation drawn = camera(1.0, seed);
    const ColourVariation& colour = drawn.colour;
    const DepthVariation& depth = drawn.depth;
    min_red = std::min(min_red, colour.white_balance_bgr[2]);
    max_red = std::max(max_red, colour.white_balance_bgr[2]);
    EXPECT_NEAR(colour.white_balance_bgr[0] * colour.white_balance_bgr[2], 1.0, 1e-9) << "warm or cold";
    EXPECT_TRUE(colour.jpeg_quality == 0 || (colour.jpeg_quality >= 30 && colour.jpeg_quality <= 95));
    compressed += colour.jpeg_quality > 0 ? 1 : 0;
    mosaics.insert(colour.bayer);
    EXPECT_NEAR(depth.scale, 1.0, 0.01);
    offsets.insert(depth.offset_px[0]);
    growths.insert(depth.grown_px[1]);
    EXPECT_GE(depth.flying_pixel_fraction, 0.0);
    EXPECT_LE(depth.flying_pixel_fraction, 1.0);
    EXPECT_LE(depth.edge_loss, 1.0);
    const bool is_time_of_flight = depth.kind == DepthKind::kTimeOfFlight;
    time_of_flight += is_time_of_flight ? 1 : 0;
    EXPECT_FALSE(is_time_of_flight && (depth.disparity_step_px > 0.0 || depth.shadow_m != 0.0 || depth.noise > 0.0));
    EXPECT_FALSE(!is_time_of_flight && (depth.wiggle > 0.0 || depth.noise_light > 0.0));
  }
  EXPECT_LT(min_red, 0.78);
  EXPECT_GT(max_red, 1.28);
  EXPECT_EQ(offsets, (std::set<int>{-3, -2, -1, 0, 1, 2, 3}));
  EXPECT_EQ(growths, (std::set<int>{0, 1, 2}));
  EXPECT_EQ(mosaics, (std::set<int>{-1, 0, 1, 2, 3}));
  EXPECT_NEAR(compressed, 200, 40);
  EXPECT_NEAR(time_of_flight, 160, 40);
}

TEST(CameraRandomisation, LessStrengthChangesLess) {
  const RgbdFrame room = toy::background(3);
  double changes[3] = {0.0, 0.0, 0.0};
  const double strengths[3] = {0.2, 0.6, 1.2};
  for (int i = 0; i < 3; ++i) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      Random random(seed);
      const CameraRandomisation drawn = sample_camera(strengths[i], random);
      cv::Mat colour = room.colour.clone();
      apply_colour(drawn, colour, random);
      changes[i] += cv::norm(colour, room.colour, cv::NORM_L1) / static_cast<double>(colour.total() * kSeeds);
    }
  }
  EXPECT_LT(1.5 * changes[0], changes[1]);
  EXPECT_LT(1.2 * changes[1], changes[2]);
}

TEST(CameraRandomisation, AnySizeAndAnyStrengthIsTaken) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 2), cv::Size(7, 9), cv::Size(33, 17)}) {
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      Random random(seed);
      const CameraRandomisation drawn = sample_camera(2.0, random);
      cv::Mat colour(size, CV_8UC3, cv::Scalar(10, 120, 250));
      cv::Mat depth(size, CV_32FC1, cv::Scalar(0.8));
      const cv::Mat before = colour.clone();
      apply_colour(drawn, colour, random);
      apply_depth(drawn, {size.width, size.height, 500.0, 500.0, 0.0, 0.0}, depth, random, before);
      EXPECT_EQ(colour.size(), size);
      EXPECT_EQ(colour.type(), CV_8UC3);
      EXPECT_EQ(depth.size(), size);
      EXPECT_EQ(depth.type(), CV_32FC1);
    }
  }
}

/// Returns whether the image of a background was randomised.
bool looks_through_another(double fraction, double strength, std::uint64_t seed) {
  const RgbdFrame room = toy::background(3);
  RgbdFrame frame = room;
  frame.colour = room.colour.clone();
  frame.depth = room.depth.clone();
  Random random(seed);
  randomise_camera(fraction, strength, frame, random);
  const bool same_depth = cv::countNonZero(frame.depth == room.depth) == cv::countNonZero(room.depth == room.depth);
  const bool same_colour = cv::norm(frame.colour, room.colour, cv::NORM_INF) == 0.0;
  if (fraction <= 0.0 || strength <= 0.0) {
    EXPECT_EQ(random.bits(), Random(seed).bits()) << "something was drawn";
  }
  return !same_depth || !same_colour;
}

TEST(CameraRandomisation, AnotherCameraLooksInItsShareOfTheImages) {
  int by_half = 0;
  int by_all = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    EXPECT_FALSE(looks_through_another(0.0, 1.0, seed));
    EXPECT_FALSE(looks_through_another(1.0, 0.0, seed));
    by_all += looks_through_another(1.0, 1.0, seed) ? 1 : 0;
    by_half += looks_through_another(0.5, 1.0, seed) ? 1 : 0;
  }
  EXPECT_NEAR(by_half, 30, 12);
  EXPECT_GE(by_all, kSeeds - 2) << "some differ by next to nothing";
}

}  // namespace
}  // namespace houghstream::training
