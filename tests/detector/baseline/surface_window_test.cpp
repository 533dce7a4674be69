#include "detector/baseline/surface_window.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/detector/baseline/surface_scene.hpp"

namespace houghstream::baseline {
namespace {

TEST(SurfaceWindow, TheOddSquareNearestToTheNumberOfNeighbours) {
  const std::vector<std::pair<int, int>> known{{1, 0}, {9, 1}, {100, 4}, {120, 5}, {121, 5}, {200, 7}, {225, 7}};
  for (const auto& [neighbours, radius] : known) EXPECT_EQ(surface_window_radius(neighbours), radius) << neighbours;
}

TEST(SurfaceWindow, TheDepthLimitGrowsWithTheWindowsSizeInMetres) {
  const Camera camera{320, 240, 260.0, 260.0, 160.0, 120.0};
  EXPECT_FLOAT_EQ(same_surface_limit(camera, 0.4F, 5), 0.02F);
  EXPECT_FLOAT_EQ(same_surface_limit(camera, 2.0F, 5), 1.5F * 5 * 2.0F / 260.0F);
  EXPECT_TRUE(std::isnan(same_surface_limit(camera, scene::kNone, 5)));
  EXPECT_FLOAT_EQ(same_surface_limit(0.01), 0.02F);
  EXPECT_FLOAT_EQ(same_surface_limit(0.1), 0.15F);
}

TEST(SurfaceWindow, EveryNeighbourIsVisitedOnce) {
  const cv::Size size(9, 6);
  for (int y = 0; y < size.height; ++y) {
    cv::Mat visits = cv::Mat::zeros(size.width, size.area(), CV_32SC1);  // row: the pixel of row y; column: neighbour
    for_each_shift(size, y, 2, [&](const WindowShift& shift) {
      const auto [v, dx, first_x, last_x] = shift;
      for (int x = first_x; x < last_x; ++x) ++visits.at<int>(x, v * size.width + x + dx);
    });
    for (int x = 0; x < size.width; ++x) {
      for (int n = 0; n < size.area(); ++n) {
        const bool inside = std::abs(n % size.width - x) <= 2 && std::abs(n / size.width - y) <= 2;
        EXPECT_EQ(visits.at<int>(x, n), inside ? 1 : 0);
      }
    }
  }
}

/// Returns random vectors on two surfaces 10 cm apart, some missing.
SurfaceVectors random_vectors() {
  SurfaceVectors vectors;
  vectors.camera = {24, 10, 260.0, 260.0, 11.5, 4.5};
  vectors.depth = cv::Mat(10, 24, CV_32FC1, cv::Scalar(0.8));
  vectors.depth.colRange(12, 24).setTo(0.9);
  std::mt19937 random(4);
  std::uniform_real_distribution<float> value(-1.0F, 1.0F);
  for (cv::Mat& plane : vectors.xyz) {
    plane.create(10, 24, CV_32FC1);
    for (float& element : cv::Mat_<float>(plane)) element = value(random);
  }
  for (const cv::Point hole : {cv::Point(3, 3), cv::Point(4, 5), cv::Point(12, 6)}) {
    vectors.depth.at<float>(hole) = scene::kNone;
    for (cv::Mat& plane : vectors.xyz) plane.at<float>(hole) = scene::kNone;
  }
  return vectors;
}

WindowMoments slow_moments(const SurfaceVectors& vectors, int x, int y, int radius) {
  std::vector<Eigen::Vector3d> near;
  const float middle = vectors.depth.at<float>(y, x);
  for (int v = std::max(0, y - radius); v <= std::min(9, y + radius); ++v) {
    for (int u = std::max(0, x - radius); u <= std::min(23, x + radius); ++u) {
      if (!(std::fabs(vectors.depth.at<float>(v, u) - middle) < 0.05F)) continue;
      near.emplace_back(vectors.xyz[0].at<float>(v, u), vectors.xyz[1].at<float>(v, u), vectors.xyz[2].at<float>(v, u));
    }
  }
  WindowMoments moments;
  moments.count = static_cast<int>(near.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& n : near) mean += n / moments.count;
  for (const auto& n : near) moments.covariance += (n - mean) * (n - mean).transpose() / moments.count;
  return moments;
}

TEST(SurfaceWindow, MomentsAreThoseOfTheNeighboursOnTheSameSurface) {
  const SurfaceVectors vectors = random_vectors();
  for (int y = 0; y < 10; ++y) {
    const std::vector<WindowMoments> row = row_moments(vectors, y, 3);
    ASSERT_EQ(row.size(), 24U);
    for (int x = 0; x < 24; ++x) {
      const WindowMoments expected = slow_moments(vectors, x, y, 3);
      const WindowMoments& found = row[static_cast<std::size_t>(x)];
      EXPECT_EQ(found.count, expected.count) << x << "," << y;
      EXPECT_LT((found.covariance - expected.covariance).cwiseAbs().maxCoeff(), 1e-5) << x << "," << y;
    }
  }
}

}  // namespace
}  // namespace houghstream::baseline
