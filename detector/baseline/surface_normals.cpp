#include "detector/baseline/surface_normals.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "pipeline/base/no_value.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::baseline {

namespace {

SurfaceVectors points_of(const WorkingFrame& frame) {
  SurfaceVectors points;
  points.depth = frame.filled_depth;
  points.camera = frame.camera;
  for (cv::Mat& coordinate : points.xyz) coordinate.create(frame.filled_depth.size(), CV_32FC1);
  for (int y = 0; y < frame.filled_depth.rows; ++y) {
    const auto* depth = frame.filled_depth.ptr<float>(y);
    for (int x = 0; x < frame.filled_depth.cols; ++x) {
      const Eigen::Vector3f point = frame.camera.backproject(x, y, depth[x]).cast<float>();
      for (int i = 0; i < 3; ++i) points.xyz[static_cast<std::size_t>(i)].ptr<float>(y)[x] = point[i];
    }
  }
  return points;
}

cv::Vec3f normal_of(const WindowMoments& moments, const Eigen::Vector3d& ray, int min_points) {
  if (moments.count < min_points) return {kNoValue, kNoValue, kNoValue};
  const Eigen::Vector3d normal = facing_normal(moments.covariance, ray);
  return {static_cast<float>(normal.x()), static_cast<float>(normal.y()), static_cast<float>(normal.z())};
}

}  // namespace

Eigen::Vector3d facing_normal(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& ray) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  return normal.dot(ray) > 0.0 ? Eigen::Vector3d(-normal) : normal;
}

cv::Mat surface_normals(const WorkingFrame& frame, int neighbours, int threads) {
  const int radius = surface_window_radius(neighbours);
  const int min_points = (2 * radius + 1) * (2 * radius + 1) / 4;
  const SurfaceVectors points = points_of(frame);
  cv::Mat normals(frame.filled_depth.size(), CV_32FC3);
  parallel_for(threads, normals.rows, [&](int y) {
    const std::vector<WindowMoments> moments = row_moments(points, y, radius);
    auto* out = normals.ptr<cv::Vec3f>(y);
    for (int x = 0; x < normals.cols; ++x) {
      out[x] = normal_of(moments[static_cast<std::size_t>(x)], frame.camera.backproject(x, y, 1.0), min_points);
    }
  });
  return normals;
}

SurfaceVectors normal_vectors(const WorkingFrame& frame, const cv::Mat& normals) {
  SurfaceVectors vectors;
  vectors.camera = frame.camera;
  cv::split(normals, vectors.xyz.data());
  vectors.depth = frame.filled_depth.clone();
  for (int y = 0; y < normals.rows; ++y) {
    for (int x = 0; x < normals.cols; ++x) {
      if (std::isnan(normals.at<cv::Vec3f>(y, x)[2])) vectors.depth.at<float>(y, x) = kNoValue;
    }
  }
  return vectors;
}

}  // namespace houghstream::baseline
