#include "detector/training/pictures/misfits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "tests/detector/toy_data.hpp"

namespace houghstream {
namespace {

constexpr int kSide = 60;
const cv::Rect kNear(20, 20, 20, 20);

/// Something near in the middle, a hole at the left.
cv::Mat near_square() {
  cv::Mat depth(kSide, kSide, CV_32FC1, cv::Scalar(1.5));
  depth(kNear) = 0.5;
  depth.colRange(0, 10) = std::numeric_limits<float>::quiet_NaN();
  return depth;
}

cv::Mat misregistered(std::uint64_t seed) {
  cv::Mat depth = near_square();
  Random random(seed);
  misregister(1.0, depth, random);
  return depth;
}

TEST(Misfits, MisregisteredDepthIsGrownAndMovedByAtMostTwoPixels) {
  bool was_grown = false;
  bool was_moved = false;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const cv::Mat depth = misregistered(seed);
    const cv::Rect near = cv::boundingRect(depth == 0.5F);
    EXPECT_EQ(near.area(), cv::countNonZero(depth == 0.5F)) << "no other depth comes up";
    EXPECT_EQ(cv::countNonZero(depth == 0.5F) + cv::countNonZero(depth == 1.5F), cv::countNonZero(depth == depth));
    for (const int grown : {near.width - kNear.width, near.height - kNear.height}) {
      EXPECT_GE(grown, 0);
      EXPECT_LE(grown, 4);
      was_grown = was_grown || grown == 4;
    }
    const cv::Point moved = (near.tl() + near.br()) - (kNear.tl() + kNear.br());
    EXPECT_LE(std::abs(moved.x), 4) << "twice the way of the middle";
    EXPECT_LE(std::abs(moved.y), 4);
    was_moved = was_moved || std::abs(moved.x) == 4;
  }
  EXPECT_TRUE(was_grown && was_moved);
}

TEST(Misfits, HolesStayHoles) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const cv::Mat depth = misregistered(seed);
    const int lost = kSide * kSide - cv::countNonZero(depth == depth);
    EXPECT_NEAR(lost, 10 * kSide, 2 * kSide) << "they move with the rest";
  }
}

TEST(Misfits, WithoutStrengthDepthStaysAsItIs) {
  cv::Mat depth = near_square();
  Random random(1);
  misregister(0.0, depth, random);
  EXPECT_EQ(cv::countNonZero(depth == near_square()), 50 * kSide) << "a hole is not equal to itself";
  const TrainingView view = toy::training_views().front();
  const TrainingView same = bent(view, 0.0, random);
  EXPECT_EQ(cv::norm(same.frame.depth, view.frame.depth, cv::NORM_INF, view.mask), 0.0);
}

TEST(Misfits, ABentViewKeepsColourAndOutlineAndItsOwnDepthIsLeftAlone) {
  const TrainingView view = toy::training_views().front();
  const cv::Mat before = view.frame.depth.clone();
  Random random(2);
  const TrainingView out = bent(view, 1.0, random);
  EXPECT_EQ(out.frame.colour.data, view.frame.colour.data);
  EXPECT_EQ(out.mask.data, view.mask.data);
  EXPECT_EQ(cv::norm(view.frame.depth, before, cv::NORM_INF, view.mask), 0.0);
  EXPECT_GT(cv::norm(out.frame.depth, before, cv::NORM_INF, view.mask), 0.0);
}

TEST(Misfits, ABentViewLeansWithinItsLimits) {
  const TrainingView view = toy::training_views().front();
  const double reach = 0.5 * std::hypot(view.frame.depth.cols, view.frame.depth.rows) *
                       view.frame.camera.metres_per_px(view.T_camera_object.translation().z());
  double most = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    const TrainingView out = bent(view, 1.0, random);
    const double change = cv::norm(out.frame.depth, view.frame.depth, cv::NORM_INF, view.mask);
    EXPECT_LT(change, 0.1 * reach + 5 * 0.002);
    most = std::max(most, change);
  }
  EXPECT_GT(most, 0.002);
}

TEST(Misfits, TheSameSeedMisfitsAlike) {
  const cv::Mat first = misregistered(7);
  const cv::Mat second = misregistered(7);
  EXPECT_EQ(cv::countNonZero(first == second), cv::countNonZero(first == first));
  const TrainingView view = toy::training_views().front();
  Random random(8);
  Random again(8);
  EXPECT_EQ(cv::norm(bent(view, 1.0, random).frame.depth, bent(view, 1.0, again).frame.depth, cv::NORM_INF, view.mask),
            0.0);
}

}  // namespace
}  // namespace houghstream
