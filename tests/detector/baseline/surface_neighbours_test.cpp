#include "detector/baseline/surface_neighbours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/detector/baseline/surface_scene.hpp"

namespace houghstream::baseline {
namespace {

PointHistogramSettings settings() {
  PointHistogramSettings out;
  out.spacing = 0.004F;
  out.step_px = 2;
  return out;
}

WorkingFrame wall_at(double distance, double enlarged = 1.0) {
  WorkingFrame frame = scene::see(120, 90, scene::Plane{Eigen::Vector3d(0, 0, -1), -distance});
  frame.camera.fx *= enlarged;
  frame.camera.fy *= enlarged;
  return frame;
}

/// Returns the distance, metres, from the middle of the cloud to its farthest neighbour.
double support_of(const WorkingFrame& frame) {
  const HistogramCloud cloud = make_histogram_cloud(frame, settings(), 1);
  const CloudNeighbours near = neighbours_of(cloud, cloud.size.width / 2, cloud.size.height / 2);
  return std::sqrt(*std::max_element(near.distances_sq.begin(), near.distances_sq.end()));
}

TEST(SurfaceNeighbours, TheSupportIsThatOfSoManyNeighboursInMetres) {
  const double radius = 0.004 * std::sqrt(200.0 / M_PI);  // 32 mm
  EXPECT_NEAR(support_of(wall_at(0.7)), radius, 0.15 * radius);
  EXPECT_NEAR(support_of(wall_at(1.4)), radius, 0.15 * radius);
  EXPECT_NEAR(support_of(wall_at(1.4, 2.0)), radius, 0.15 * radius);
}

TEST(SurfaceNeighbours, FarAwayThePointsBesideAreTheNeighboursNearbyTheSupportIsCutOff) {
  const HistogramCloud far = make_histogram_cloud(wall_at(8.0), settings(), 1);
  EXPECT_GE(neighbours_of(far, 30, 20).indices.size(), 5U);
  const HistogramCloud near = make_histogram_cloud(wall_at(0.1), settings(), 1);
  const std::size_t middle = near.index(30, 20);
  EXPECT_EQ(near.reaches[middle], HistogramCloud::kMaxDistance);
  EXPECT_FALSE(neighbours_of(near, 30, 20).indices.empty());
}

TEST(SurfaceNeighbours, NeighboursLieOnThePointsOwnSurfaceItselfFirst) {
  WorkingFrame frame = wall_at(0.7);
  frame.filled_depth.colRange(60, 120).setTo(0.9);
  const HistogramCloud cloud = make_histogram_cloud(frame, settings(), 1);
  const CloudNeighbours near = neighbours_of(cloud, 28, 20);
  ASSERT_GT(near.indices.size(), 10U);
  EXPECT_EQ(near.indices.front(), static_cast<pcl::index_t>(cloud.index(28, 20)));
  EXPECT_EQ(near.distances_sq.front(), 0.0F);
  for (const auto i : near.indices) EXPECT_FLOAT_EQ(cloud.points[static_cast<std::size_t>(i)].z, 0.7F);
}

TEST(SurfaceNeighbours, WhereDepthIsMissingThereIsNeitherPointNorNeighbour) {
  WorkingFrame frame = wall_at(0.7);
  frame.filled_depth.colRange(60, 120).setTo(scene::kNone);
  const HistogramCloud cloud = make_histogram_cloud(frame, settings(), 1);
  EXPECT_TRUE(std::isnan(cloud.points[cloud.index(40, 20)].z));
  EXPECT_TRUE(neighbours_of(cloud, 40, 20).indices.empty());
  for (const auto i : neighbours_of(cloud, 28, 20).indices) EXPECT_LT(i % cloud.size.width, 30);
}

TEST(SurfaceNeighbours, NormalsAreThoseOfTheSurfaceForAnyNumberOfThreads) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, -0.8).normalized();
  WorkingFrame frame = scene::see(120, 90, scene::Plane{normal, 0.7 * normal.z()});
  scene::add_noise(frame, 0.0005, 5);
  const HistogramCloud cloud = make_histogram_cloud(frame, settings(), 1);
  const HistogramCloud again = make_histogram_cloud(frame, settings(), 3);
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f found = cloud.normals[i].getNormalVector3fMap();
    ASSERT_FALSE(std::isnan(cloud.points[i].z)) << i;
    EXPECT_GT(found.cast<double>().dot(normal), 0.99) << i;
    EXPECT_TRUE(found == again.normals[i].getNormalVector3fMap()) << i;
  }
}

}  // namespace
}  // namespace houghstream::baseline
