#include "pose/verification/colour_sums.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

std::vector<ComparedPoint> random_points(std::size_t count) {
  Random random(9);
  std::vector<ComparedPoint> points(count);
  for (ComparedPoint& point : points) {
    const auto colour = [&] { return static_cast<float>(random.below(256) - 128); };
    const auto along = [&] { return static_cast<float>(random.uniform(-100.0, 100.0)); };
    point.own = {colour(), colour(), colour(), 1.0F};
    point.seen = {colour(), colour(), colour(), 1.0F};
    point.normal = {along(), along(), along(), 1.0F};
  }
  return points;
}

/// All products of the columns, in double precision.
ColourProducts readable_means(const std::vector<ComparedPoint>& points) {
  ColourProducts means = ColourProducts::Zero();
  for (const ComparedPoint& point : points) {
    Eigen::Matrix<double, kColourColumns, 1> row;
    row << point.own[0], point.normal[0], point.normal[1], point.normal[2], 1.0, point.own[1], point.own[2],
        point.seen[0], point.seen[1], point.seen[2];
    means += row * row.transpose() / static_cast<double>(points.size());
  }
  return means;
}

TEST(ColourSums, MeansAreThoseOfAllProductsWhereTheyAreSummed) {
  const std::vector<ComparedPoint> points = random_points(300);
  ColourSums sums;
  sums.add(points, 64);
  sums.add(std::vector<ComparedPoint>(points.begin() + 64, points.end()), points.size() - 64);
  EXPECT_EQ(sums.count(), 300);
  const ColourProducts means = sums.means();
  const ColourProducts expected = readable_means(points);
  constexpr Eigen::Index kTerms = kOne + 1;
  const auto near = [&](Eigen::Index a, Eigen::Index b) {
    EXPECT_NEAR(means(a, b), expected(a, b), 1e-2) << a << ' ' << b;
    EXPECT_EQ(means(a, b), means(b, a));
  };
  for (Eigen::Index a = 0; a < kTerms; ++a) {
    for (Eigen::Index b = 0; b < kTerms; ++b) near(a, b);
    near(a, kSeenLightness);
  }
  for (const Eigen::Index column : {kA, kB, kSeenLightness, kSeenA, kSeenB}) {
    near(column, column);
    near(column, kOne);
  }
  near(kA, kSeenA);
  near(kB, kSeenB);
}

}  // namespace
}  // namespace houghstream
