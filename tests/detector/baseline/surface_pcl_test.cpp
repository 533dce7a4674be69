// These tests compare the organised image with PCL's search for the k nearest points, on the same cloud.
#include <gtest/gtest.h>
#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/features/pfh.h>
#include <pcl/features/principal_curvatures.h>
#include <pcl/search/kdtree.h>

#include <algorithm>

#include "detector/baseline/surface_curvature.hpp"
#include "detector/baseline/surface_histograms.hpp"
#include "detector/baseline/surface_normals.hpp"
#include "tests/detector/baseline/surface_scene.hpp"

namespace houghstream::baseline {
namespace {

using Points = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;

WorkingFrame noisy_sphere() {
  WorkingFrame frame = scene::ball_on_table(120, 90);
  scene::add_noise(frame, 0.001, 2);
  return frame;
}

Points::Ptr cloud_of(const WorkingFrame& frame) {
  Points::Ptr cloud(new Points);
  for (int y = 0; y < frame.filled_depth.rows; ++y) {
    for (int x = 0; x < frame.filled_depth.cols; ++x) {
      const Eigen::Vector3d point = frame.camera.backproject(x, y, frame.filled_depth.at<float>(y, x));
      cloud->emplace_back(static_cast<float>(point.x()), static_cast<float>(point.y()), static_cast<float>(point.z()));
    }
  }
  return cloud;
}

pcl::search::KdTree<pcl::PointXYZ>::Ptr tree() {
  return pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>);
}

Normals::Ptr searched_normals(const Points::Ptr& cloud, int neighbours) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(tree());
  estimation.setKSearch(neighbours);
  Normals::Ptr normals(new Normals);
  estimation.compute(*normals);
  return normals;
}

/// Returns the features of PCL's estimation of this type, at every point.
template <typename Estimation, typename Out>
pcl::PointCloud<Out> search_features(const Points::Ptr& cloud, const Normals::Ptr& normals, int neighbours) {
  Estimation estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(normals);
  estimation.setSearchMethod(tree());
  estimation.setKSearch(neighbours);
  pcl::PointCloud<Out> out;
  estimation.compute(out);
  return out;
}

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST(SurfacePcl, NormalsAgree) {
  const WorkingFrame frame = noisy_sphere();
  const Normals::Ptr expected = searched_normals(cloud_of(frame), 81);
  const cv::Mat found = surface_normals(frame, 81, 1);
  std::vector<float> degrees;
  for (std::size_t i = 0; i < expected->size(); ++i) {
    const cv::Vec3f& n = found.at<cv::Vec3f>(static_cast<int>(i));
    if (std::isnan(n[2])) continue;
    const float cosine = (*expected)[i].getNormalVector3fMap().dot(Eigen::Vector3f(n[0], n[1], n[2]));
    degrees.push_back(std::acos(std::min(1.0F, cosine)) * 180.0F / 3.14159F);
  }
  EXPECT_GT(degrees.size(), expected->size() * 95 / 100);
  EXPECT_LT(median(degrees), 0.8F);
}

struct CurvatureDifference {
  float spread;            ///< median
  float direction_cosine;  ///< median
};

CurvatureDifference compare_curvatures(const WorkingFrame& frame) {
  using Estimation = pcl::PrincipalCurvaturesEstimation<pcl::PointXYZ, pcl::Normal, pcl::PrincipalCurvatures>;
  const Points::Ptr cloud = cloud_of(frame);
  const auto expected = search_features<Estimation, pcl::PrincipalCurvatures>(cloud, searched_normals(cloud, 81), 225);
  const SurfaceVectors normals = normal_vectors(frame, surface_normals(frame, 81, 1));
  std::vector<float> spreads;
  std::vector<float> cosines;
  for (int y = 0; y < frame.filled_depth.rows; ++y) {
    const std::vector<Curvature> row = row_curvatures(normals, y, surface_window_radius(225));
    for (int x = 0; x < frame.filled_depth.cols; ++x) {
      const Curvature& ours = row[static_cast<std::size_t>(x)];
      if (std::isnan(ours.max)) continue;
      const auto& theirs = expected[static_cast<std::size_t>(y * frame.filled_depth.cols + x)];
      spreads.push_back(std::fabs(std::sqrt(ours.max) - std::sqrt(theirs.pc1)));
      const cv::Vec3f direction(theirs.principal_curvature_x, theirs.principal_curvature_y,
                                theirs.principal_curvature_z);
      cosines.push_back(std::fabs(ours.direction.dot(direction)));
    }
  }
  EXPECT_GT(spreads.size(), expected.size() * 95 / 100);
  return {median(spreads), median(cosines)};
}

TEST(SurfacePcl, CurvaturesAgree) {
  EXPECT_LT(compare_curvatures(noisy_sphere()).spread, 0.005F);
  const scene::Round can{Eigen::Vector3d(0.0, 0.0, 1.1), 0.3, Eigen::Vector3d(0.6, 0.8, 0.0)};
  WorkingFrame frame = scene::see(80, 60, can);
  scene::add_noise(frame, 0.0003, 3);
  const CurvatureDifference on_can = compare_curvatures(frame);
  EXPECT_LT(on_can.spread, 0.005F);
  EXPECT_GT(on_can.direction_cosine, 0.999F);
}

/// Returns the median over the ball's pixels of the sum of the differences, as a fraction of the histograms: 2 where
/// they have nothing in common.
template <typename Cloud>
float difference(const std::vector<cv::Mat>& planes, const Cloud& expected, const Points& cloud) {
  std::vector<float> differences;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!(cloud[i].z < 0.8F)) continue;
    float apart = 0.0F;
    float all = 0.0F;
    for (std::size_t p = 0; p < planes.size(); ++p) {
      const float theirs = 2.55F * expected[i].histogram[p];
      apart += std::fabs(static_cast<float>(planes[p].data[i]) - theirs);
      all += theirs;
    }
    differences.push_back(apart / all);
  }
  EXPECT_GT(differences.size(), cloud.size() / 10);
  return median(differences);
}

TEST(SurfacePcl, HistogramsAgree) {
  const scene::Plane wall{Eigen::Vector3d(0.3, 0.0, -0.954), -0.9};
  const scene::Round ball{Eigen::Vector3d(0.0, 0.0, 0.8), 0.04};
  const WorkingFrame frame = scene::see(48, 36, [&](const Eigen::Vector3d& ray) {
    const double depth = ball(ray);
    return std::isnan(depth) ? wall(ray) : depth;
  });
  const Points::Ptr cloud = cloud_of(frame);
  PointHistogramSettings settings;
  settings.step_px = 1;
  settings.spacing = static_cast<float>(frame.camera.metres_per_px(0.77));
  settings.normal_neighbours = 49;
  settings.neighbours = 64;
  settings.given = 64;
  const Normals::Ptr normals = searched_normals(cloud, settings.normal_neighbours);
  const auto fpfh =
      search_features<pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33>, pcl::FPFHSignature33>(
          cloud, normals, settings.neighbours);
  EXPECT_LT(difference(fpfh_planes(frame, settings, 1), fpfh, *cloud), 0.18F);
  const auto pfh =
      search_features<pcl::PFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::PFHSignature125>, pcl::PFHSignature125>(
          cloud, normals, settings.neighbours);
  EXPECT_LT(difference(pfh_planes(frame, settings, 1), pfh, *cloud), 0.35F);
}

}  // namespace
}  // namespace houghstream::baseline
