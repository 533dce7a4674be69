#include "detector/training/augmentation/sensor_errors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "detector/training/augmentation/composites.hpp"
#include "tests/detector/toy_data.hpp"

namespace houghstream::training {
namespace {

constexpr int kSide = 60;
const cv::Rect kNearSquare(20, 20, 20, 20);

/// Returns the depth of a near square in the middle, with a hole at the left.
cv::Mat image_with_near_square() {
  cv::Mat depth(kSide, kSide, CV_32FC1, cv::Scalar(1.5));
  depth(kNearSquare) = 0.5;
  depth.colRange(0, 10) = std::numeric_limits<float>::quiet_NaN();
  return depth;
}

cv::Mat misregistered(std::uint64_t seed) {
  cv::Mat depth = image_with_near_square();
  Random random(seed);
  misregister(1.0, depth, random);
  return depth;
}

TEST(Misregistration, MisregisteredDepthIsGrownAndMovedByAtMostTwoPixels) {
  bool was_grown = false;
  bool was_moved = false;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const cv::Mat depth = misregistered(seed);
    const cv::Rect near = cv::boundingRect(depth == 0.5F);
    EXPECT_EQ(near.area(), cv::countNonZero(depth == 0.5F)) << "no other depth comes up";
    EXPECT_EQ(cv::countNonZero(depth == 0.5F) + cv::countNonZero(depth == 1.5F), cv::countNonZero(depth == depth));
    for (const int grown : {near.width - kNearSquare.width, near.height - kNearSquare.height}) {
      EXPECT_GE(grown, 0);
      EXPECT_LE(grown, 4);
      was_grown = was_grown || grown == 4;
    }
    const cv::Point moved = (near.tl() + near.br()) - (kNearSquare.tl() + kNearSquare.br());
    EXPECT_LE(std::abs(moved.x), 4) << "twice the way of the middle";
    EXPECT_LE(std::abs(moved.y), 4);
    was_moved = was_moved || std::abs(moved.x) == 4;
  }
  EXPECT_TRUE(was_grown && was_moved);
}

TEST(Misregistration, HolesStayHoles) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const cv::Mat depth = misregistered(seed);
    const int lost = kSide * kSide - cv::countNonZero(depth == depth);
    EXPECT_NEAR(lost, 10 * kSide, 2 * kSide) << "they move with the rest";
  }
}

TEST(Misregistration, WithoutStrengthDepthStaysAsItIs) {
  cv::Mat depth = image_with_near_square();
  Random random(1);
  misregister(0.0, depth, random);
  EXPECT_EQ(cv::countNonZero(depth == image_with_near_square()), 50 * kSide) << "a hole is not equal to itself";
  const TrainingView view = toy::training_views().front();
  const TrainingView same = perturb_shape(view, 0.0, random);
  EXPECT_EQ(cv::norm(same.frame.depth, view.frame.depth, cv::NORM_INF, view.mask), 0.0);
}

TEST(Misregistration, ABentViewKeepsColourAndOutlineAndItsOwnDepthIsLeftAlone) {
  const TrainingView view = toy::training_views().front();
  const cv::Mat before = view.frame.depth.clone();
  Random random(2);
  const TrainingView out = perturb_shape(view, 1.0, random);
  EXPECT_EQ(out.frame.colour.data, view.frame.colour.data);
  EXPECT_EQ(out.mask.data, view.mask.data);
  EXPECT_EQ(cv::norm(view.frame.depth, before, cv::NORM_INF, view.mask), 0.0);
  EXPECT_GT(cv::norm(out.frame.depth, before, cv::NORM_INF, view.mask), 0.0);
}

TEST(Misregistration, ABentViewLeansWithinItsLimits) {
  const TrainingView view = toy::training_views().front();
  const double reach = 0.5 * std::hypot(view.frame.depth.cols, view.frame.depth.rows) *
                       view.frame.camera.metres_per_px(view.T_camera_object.translation().z());
  double maximum = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const TrainingView out = perturb_shape(view, 1.0, random);
    const double change = cv::norm(out.frame.depth, view.frame.depth, cv::NORM_INF, view.mask);
    EXPECT_LT(change, 0.1 * reach + 5 * 0.002);
    maximum = std::max(maximum, change);
  }
  EXPECT_GT(maximum, 0.002);
}

TEST(Misregistration, TheSameSeedMisfitsAlike) {
  const cv::Mat first = misregistered(7);
  const cv::Mat second = misregistered(7);
  EXPECT_EQ(cv::countNonZero(first == second), cv::countNonZero(first == first));
  const TrainingView view = toy::training_views().front();
  Random random(8);
  Random again(8);
  EXPECT_EQ(cv::norm(perturb_shape(view, 1.0, random).frame.depth, perturb_shape(view, 1.0, again).frame.depth,
                     cv::NORM_INF, view.mask),
            0.0);
}

constexpr int kWidth = 160;
constexpr int kHeight = 120;

/// Returns depth that is near on the left, far on the right, and unknown at the bottom.
cv::Mat half_near() {
  cv::Mat depth(kHeight, kWidth, CV_32FC1, cv::Scalar(1.5));
  depth.colRange(0, kWidth / 2) = 0.5;
  depth.rowRange(kHeight - 20, kHeight) = std::numeric_limits<float>::quiet_NaN();
  return depth;
}

int measured(const cv::Mat& depth) {
  return cv::countNonZero(depth == depth);
}

TEST(NearLoss, LeavesTheShareOfWhatIsNearAndAllThatIsFar) {
  const int near_px = kWidth / 2 * (kHeight - 20);
  for (const double kept : {0.05, 0.3, 1.0}) {
    cv::Mat depth = half_near();
    Random random(3);
    drop_near_depth(0.8, kept, depth, random);
    EXPECT_NEAR(measured(depth.colRange(0, kWidth / 2)), kept * near_px, 2.0);
    EXPECT_EQ(measured(depth.colRange(kWidth / 2, kWidth)), near_px);
    EXPECT_EQ(cv::countNonZero(depth == 0.5F) + cv::countNonZero(depth == 1.5F), measured(depth)) << "values stay";
  }
}

TEST(NearLoss, WhatStaysLiesInPatches) {
  cv::Mat depth(kHeight, kWidth, CV_32FC1, cv::Scalar(0.5));
  Random random(4);
  drop_near_depth(0.8, 0.25, depth, random);
  int kept = 0;
  int with_right_neighbour = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x + 1 < kWidth; ++x) {
      if (!(depth.at<float>(y, x) > 0.0F)) continue;
      ++kept;
      with_right_neighbour += depth.at<float>(y, x + 1) > 0.0F ? 1 : 0;
    }
  }
  EXPECT_GT(with_right_neighbour, 0.7 * kept) << "single pixels would have a quarter";
}

TEST(NearLoss, WithoutAnythingNearAllStays) {
  cv::Mat depth = half_near();
  Random random(5);
  drop_near_depth(0.2, 0.05, depth, random);
  EXPECT_EQ(measured(depth), measured(half_near()));
}

TEST(NearLoss, TheSameSeedLosesTheSame) {
  cv::Mat first = half_near();
  cv::Mat second = half_near();
  Random random(6);
  drop_near_depth(0.8, 0.2, first, random);
  Random again(6);
  drop_near_depth(0.8, 0.2, second, again);
  EXPECT_EQ(cv::countNonZero((first == first) != (second == second)), 0);
}

cv::Mat noisy(double ratio) {
  cv::Mat depth(240, 320, CV_32FC1, cv::Scalar(0.7));
  Random random(3);
  add_far_noise(0.7, ratio, depth, random);
  return depth;
}

double stddev_of(const cv::Mat& values) {
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(values, mean, sigma);
  EXPECT_NEAR(mean[0], 0.7, 0.001);
  return sigma[0];
}

/// Returns the deviation of neighbouring pixels' difference over that of all pixels: 1.41 where they are independent.
double contrast_of(const cv::Mat& values) {
  cv::Mat difference = values.colRange(1, values.cols) - values.colRange(0, values.cols - 1) + 0.7;
  return stddev_of(difference) / stddev_of(values);
}

TEST(FarNoise, AddsWhatTheLargerDistanceHasMore) {
  for (const double ratio : {1.5, 2.3}) {
    const double expected = std::sqrt(std::pow(axial_noise(0.7 * ratio), 2) - std::pow(axial_noise(0.7), 2));
    EXPECT_NEAR(stddev_of(noisy(ratio)), expected, 0.25 * expected) << ratio;  // interpolation takes some of it
  }
}

TEST(FarNoise, IsAsCoarseAsTheImagesOfThatDistanceEnlarged) {
  EXPECT_LT(contrast_of(noisy(1.2)), 0.9);
  EXPECT_LT(contrast_of(noisy(2.4)), 0.6 * contrast_of(noisy(1.2)));
}

TEST(FarNoise, NothingIsAddedAtTheOwnDistanceAndNothingMissingIsMadeUp) {
  EXPECT_EQ(cv::norm(noisy(1.0), cv::Mat(240, 320, CV_32FC1, cv::Scalar(0.7)), cv::NORM_INF), 0.0);
  cv::Mat depth(20, 30, CV_32FC1, cv::Scalar(0.7));
  depth.at<float>(4, 5) = std::numeric_limits<float>::quiet_NaN();
  Random random(3);
  add_far_noise(0.7, 2.0, depth, random);
  EXPECT_TRUE(std::isnan(depth.at<float>(4, 5)));
  EXPECT_FALSE(std::isnan(depth.at<float>(4, 6)));
}

TEST(Resurfaced, WithoutStrengthColoursStayAsTheyAre) {
  const TrainingView view = toy::training_views().front();
  Random random(1);
  const TrainingView same = perturb_appearance(view, 0.0, random);
  EXPECT_EQ(cv::norm(same.frame.colour, view.frame.colour, cv::NORM_INF), 0.0);
  EXPECT_EQ(random.bits(), Random(1).bits()) << "nothing is drawn";
}

TEST(Resurfaced, OnlyTheObjectsColoursChange) {
  const TrainingView view = toy::training_views().front();
  const TrainingView untouched = toy::training_views().front();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const TrainingView other = perturb_appearance(view, 1.0, random);
    EXPECT_GT(cv::norm(other.frame.colour, view.frame.colour, cv::NORM_INF, view.mask), 0.0);
    EXPECT_EQ(cv::norm(other.frame.colour, view.frame.colour, cv::NORM_INF, ~view.mask), 0.0) << "seed " << seed;
    EXPECT_EQ(cv::norm(other.mask, view.mask, cv::NORM_INF), 0.0);
    EXPECT_EQ(cv::countNonZero(other.frame.depth != view.frame.depth), 0);
  }
  EXPECT_EQ(cv::norm(view.frame.colour, untouched.frame.colour, cv::NORM_INF), 0.0) << "the view's own stay";
}

/// Returns the mean change of the object's colours over some seeds, 8-bit steps.
double change_by(double strength) {
  const TrainingView view = toy::training_views().front();
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    sum +=
        cv::norm(perturb_appearance(view, strength, random).frame.colour, view.frame.colour, cv::NORM_L1, view.mask) /
        cv::countNonZero(view.mask);
  }
  return sum / 20.0;
}

TEST(Resurfaced, MoreStrengthChangesMore) {
  EXPECT_GT(change_by(0.3), 1.0);
  EXPECT_GT(change_by(1.0), 1.5 * change_by(0.3));
}

TEST(Resurfaced, TheSameSeedIsTheSameSurface) {
  const TrainingView view = toy::training_views().front();
  const auto surface = [&](std::uint64_t seed) {
    Random random(seed);
    return perturb_appearance(view, 1.0, random).frame.colour;
  };
  EXPECT_EQ(cv::norm(surface(3), surface(3), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(surface(3), surface(4), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace houghstream::training
