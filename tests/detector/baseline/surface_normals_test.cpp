#include "detector/baseline/surface_normals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/detector/baseline/surface_scene.hpp"

namespace houghstream::baseline {
namespace {

constexpr int kNeighbours = 100;

double angle_deg(const cv::Vec3f& found, const Eigen::Vector3d& expected) {
  const Eigen::Vector3d normal(found[0], found[1], found[2]);
  return std::atan2(normal.cross(expected).norm(), normal.dot(expected)) * 180.0 / M_PI;
}

TEST(SurfaceNormals, APlaneHasItsNormalEverywhereTowardsTheCamera) {
  for (const double distance : {0.5, 1.0, 2.5}) {
    for (const Eigen::Vector3d& towards : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0.6, -0.5, -0.9)}) {
      const Eigen::Vector3d normal = towards.normalized();
      const WorkingFrame frame = scene::see(48, 36, scene::Plane{normal, distance * normal.z()});
      const cv::Mat normals = surface_normals(frame, kNeighbours, 1);
      ASSERT_EQ(normals.type(), CV_32FC3);
      double worst = 0.0;
      for (const cv::Vec3f& found : cv::Mat_<cv::Vec3f>(normals)) {
        EXPECT_NEAR(cv::norm(found), 1.0, 1e-5);
        worst = std::max(worst, angle_deg(found, normal));
      }
      EXPECT_LT(worst, 0.1) << distance;
    }
  }
}

TEST(SurfaceNormals, APlanesNormalIsTurnedAgainstTheRay) {
  const Eigen::Matrix3d flat = Eigen::Vector3d(1.0, 1e-4, 1.0).asDiagonal();
  const Eigen::Vector3d up(0.0, 1.0, 0.0);
  EXPECT_NEAR(facing_normal(flat, {0.3, -0.1, 1.0}).dot(up), 1.0, 1e-6);
  EXPECT_NEAR(facing_normal(flat, {0.3, 0.1, 1.0}).dot(up), -1.0, 1e-6);
}

TEST(SurfaceNormals, NoiseIsAveraged) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, -1.0).normalized();
  WorkingFrame frame = scene::see(48, 36, scene::Plane{normal, normal.z()});
  scene::add_noise(frame, 0.002, 1);
  const cv::Mat normals = surface_normals(frame, kNeighbours, 1);
  double sum = 0.0;
  for (const cv::Vec3f& found : cv::Mat_<cv::Vec3f>(normals)) sum += angle_deg(found, normal);
  EXPECT_LT(sum / static_cast<double>(normals.total()), 3.0);
}

TEST(SurfaceNormals, ASphereHasItsRadii) {
  const Eigen::Vector3d centre(0.0, 0.0, 0.9);
  const WorkingFrame frame = scene::see(80, 80, scene::Round{centre, 0.1});
  const cv::Mat normals = surface_normals(frame, kNeighbours, 1);
  int known = 0;
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 80; ++x) {
      const Eigen::Vector3d point = frame.camera.backproject(x, y, frame.filled_depth.at<float>(y, x));
      if (!((point - centre).normalized().z() < -0.5)) continue;  // less than 60 degrees from the front
      EXPECT_LT(angle_deg(normals.at<cv::Vec3f>(y, x), (point - centre).normalized()), 2.5) << x << "," << y;
      ++known;
    }
  }
  EXPECT_GT(known, 1500);
}

TEST(SurfaceNormals, AStepInDepthBendsNothing) {
  const WorkingFrame frame = scene::see(48, 36, [](const Eigen::Vector3d& ray) { return ray.x() < 0.0 ? 0.8 : 0.9; });
  const cv::Mat normals = surface_normals(frame, kNeighbours, 1);
  for (int x = 0; x < 48; ++x) EXPECT_LT(angle_deg(normals.at<cv::Vec3f>(18, x), {0, 0, -1}), 0.1) << x;
}

TEST(SurfaceNormals, WhereThereIsNoSurfaceThereIsNoNormal) {
  WorkingFrame frame = scene::see(48, 36, scene::Plane{Eigen::Vector3d(0, 0, -1), -0.8});
  frame.filled_depth.colRange(24, 48).setTo(scene::kNone);
  frame.filled_depth.at<float>(10, 10) = scene::kNone;
  frame.filled_depth.at<float>(18, 40) = 0.8F;  // alone
  const cv::Mat normals = surface_normals(frame, kNeighbours, 1);
  for (int y = 0; y < 36; ++y) {
    for (int x = 0; x < 48; ++x) {
      const auto& normal = normals.at<cv::Vec3f>(y, x);
      const bool expected = x < 24 && !(x == 10 && y == 10);
      for (int i = 0; i < 3; ++i) EXPECT_EQ(normal[i] == normal[i], expected) << x << "," << y;
      EXPECT_LT(expected ? angle_deg(normal, {0, 0, -1}) : 0.0, 0.1);
    }
  }
  const SurfaceVectors vectors = normal_vectors(frame, normals);
  EXPECT_FLOAT_EQ(vectors.depth.at<float>(5, 5), 0.8F);
  EXPECT_TRUE(std::isnan(vectors.depth.at<float>(18, 40)));
  EXPECT_FLOAT_EQ(frame.filled_depth.at<float>(18, 40), 0.8F);
}

TEST(SurfaceNormals, AnyNumberOfThreadsGivesTheSameNormals) {
  WorkingFrame frame = scene::ball_on_table();
  scene::add_noise(frame, 0.002, 2);
  const cv::Mat serial = surface_normals(frame, kNeighbours, 1);
  const cv::Mat parallel = surface_normals(frame, kNeighbours, 3);
  EXPECT_EQ(std::memcmp(serial.data, parallel.data, serial.total() * serial.elemSize()), 0);
}

}  // namespace
}  // namespace houghstream::baseline
