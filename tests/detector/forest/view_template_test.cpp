#include "detector/forest/view_template.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

namespace houghstream {
namespace {

constexpr int kSide = TemplateGrid::kSide;
constexpr int kRim = TemplateGrid::kRim;

std::int16_t beside(const TemplateGrid& grid, int column, int row) {
  return grid.beside[static_cast<std::size_t>(row * kSide + column)];
}

const Camera kCamera{80, 80, 100, 100, 39.5, 39.5};

/// Returns a 40 pixel wide square, its left half 10 mm nearer and red, its right half 10 mm farther and without depth
/// below.
TemplateGrid square() {
  RgbdFrame view;
  view.camera = kCamera;
  view.colour = cv::Mat(80, 80, CV_8UC3, cv::Scalar(200, 200, 200));
  view.depth = cv::Mat(80, 80, CV_32FC1, cv::Scalar(2.0));
  view.colour(cv::Rect(20, 20, 20, 40)).setTo(cv::Scalar(0, 0, 200));
  view.depth(cv::Rect(20, 20, 20, 40)).setTo(0.99F);
  view.depth(cv::Rect(40, 20, 20, 20)).setTo(1.01F);
  view.depth(cv::Rect(40, 40, 20, 20)).setTo(std::numeric_limits<float>::quiet_NaN());
  cv::Mat mask = cv::Mat::zeros(80, 80, CV_8UC1);
  const cv::Rect box(20, 20, 40, 40);
  mask(box).setTo(255);
  return make_template_grid(view, mask, box, {0.0F, 0.0F, 1.0F});
}

TEST(TemplateGrid, DepthIsRelativeToTheCentreInMillimetres) {
  const TemplateGrid grid = square();
  EXPECT_EQ(grid.depth_mm(kRim, kRim), -10);
  EXPECT_EQ(grid.depth_mm(kRim, kSide - 1 - kRim), 10);
  EXPECT_EQ(grid.depth_mm(kSide - 1 - kRim, kSide - 1 - kRim), TemplateGrid::kNoDepth);
  EXPECT_EQ(grid.depth_mm(0, 0), TemplateGrid::kNoObject);
}

TEST(TemplateGrid, TheRimKnowsTheNearestDepthOfTheObjectButNotBelow) {
  const TemplateGrid grid = square();
  EXPECT_EQ(beside(grid, 0, 6), -10);
  EXPECT_EQ(beside(grid, kSide - 1, 6), 10);
  EXPECT_EQ(beside(grid, kRim, kRim), TemplateGrid::kNoObject);  // on the object
  static_assert(TemplateGrid::kRimRows < kSide - kRim, "below there is none");
}

/// Both ends of each of the square's 20 rows and columns.
TEST(TemplateGrid, TheOutlineIsCrossedAtBothEndsOfEachLine) {
  const TemplateGrid grid = square();
  const TemplateOutline outline = find_outline(grid);
  ASSERT_EQ(outline.count, 80U);
  for (const OutlineCells& across : outline.crossings) {
    const auto on = [&](const OutlineCells::Cell& at) {
      return grid.depth_mm(at.row, at.column) != TemplateGrid::kNoObject;
    };
    EXPECT_TRUE(on(across.inside));
    EXPECT_FALSE(on(across.beyond));
    const int apart =
        std::abs(across.inside.row - across.beyond.row) + std::abs(across.inside.column - across.beyond.column);
    EXPECT_EQ(apart, OutlineCells::kApart);
    EXPECT_TRUE(across.gained_mm == 0 || across.gained_mm == TemplateGrid::kNoDepth);
  }
}

/// A strip, one cell wide, is all outline.
TEST(TemplateGrid, WhatIsTooNarrowHasFewerCrossings) {
  RgbdFrame view;
  view.camera = kCamera;
  view.colour = cv::Mat(80, 80, CV_8UC3, cv::Scalar(200, 200, 200));
  view.depth = cv::Mat(80, 80, CV_32FC1, cv::Scalar(1.0));
  cv::Mat mask = cv::Mat::zeros(80, 80, CV_8UC1);
  mask(cv::Rect(38, 20, 2, 40)).setTo(255);
  const cv::Rect box(20, 20, 40, 40);
  const TemplateGrid grid = make_template_grid(view, mask, box, {0.0F, 0.0F, 1.0F});
  EXPECT_EQ(find_outline(grid).count, 2U) << "the strip's two ends only";
}

/// The plane is 5 mm farther per pixel to the right, which is 10 mm per cell.
TEST(TemplateGrid, TheOutlineKnowsWhatASlopeGains) {
  RgbdFrame view;
  view.camera = kCamera;
  view.colour = cv::Mat(80, 80, CV_8UC3, cv::Scalar(200, 200, 200));
  view.depth = cv::Mat(80, 80, CV_32FC1);
  for (int x = 0; x < 80; ++x) view.depth.col(x).setTo(1.0 + 0.005 * (x - 40));
  cv::Mat mask = cv::Mat::zeros(80, 80, CV_8UC1);
  const cv::Rect box(20, 20, 40, 40);
  mask(box).setTo(255);
  const TemplateGrid grid = make_template_grid(view, mask, box, {0.0F, 0.0F, 1.0F});
  const TemplateOutline outline = find_outline(grid);
  ASSERT_EQ(outline.count, 80U);
  for (const OutlineCells& across : outline.crossings) {
    const int right = across.beyond.column - across.inside.column;
    EXPECT_NEAR(across.gained_mm, 10 * right, 1);
  }
}

TEST(TemplateGrid, OffTheAxisReliefIsAsItLiesAcrossTheRay) {
  const Eigen::Vector3f centre(0.3F, 0.0F, 1.0F);
  RgbdFrame view;
  view.camera = {80, 80, 100, 100, 9.5, 39.5};  // the centre at pixel (39.5, 39.5)
  view.colour = cv::Mat(80, 80, CV_8UC3, cv::Scalar(200, 200, 200));
  view.depth = cv::Mat(80, 80, CV_32FC1);
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 80; ++x) {  // a plane across the ray to the centre: (P - C) . C = 0
      const Eigen::Vector3f ray = view.camera.backproject(x, y, 1.0).cast<float>();
      view.depth.at<float>(y, x) = centre.squaredNorm() / ray.dot(centre);
    }
  }
  cv::Mat mask = cv::Mat::zeros(80, 80, CV_8UC1);
  const cv::Rect box(30, 30, 20, 20);
  mask(box).setTo(255);
  const TemplateGrid grid = make_template_grid(view, mask, box, centre);
  for (int row = kRim; row < kSide - kRim; ++row) {
    for (int column = kRim; column < kSide - kRim; ++column) EXPECT_NEAR(grid.depth_mm(row, column), 0, 2);
  }
}

TEST(TemplateGrid, ColoursAreLab) {
  const TemplateGrid grid = square();
  EXPECT_GT(grid.lab[TemplateGrid::colour_index(kRim, kRim)][1], 170);                   // red
  EXPECT_NEAR(grid.lab[TemplateGrid::colour_index(kRim, kSide - 1 - kRim)][1], 128, 3);  // grey
}

}  // namespace
}  // namespace houghstream
