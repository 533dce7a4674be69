#include "detector/baseline/surface_curvature.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "detector/baseline/surface_normals.hpp"
#include "pipeline/base/no_value.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::baseline {

namespace {

constexpr int kNeutral = 128;

/// Returns the curvature. Projecting vectors onto the plane is linear, so it is done to their covariance, which leaves
/// a 2x2 matrix in the plane.
Curvature curvature_of(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.cross(u);
  const double uu = u.dot(covariance * u);
  const double uv = u.dot(covariance * v);
  const double vv = v.dot(covariance * v);
  const double mean = 0.5 * (uu + vv);
  const double half = 0.5 * (uu - vv);
  const double root = std::sqrt(half * half + uv * uv);
  // Two rows give the eigenvector; the one without cancellation is taken.
  const Eigen::Vector3d along = half > 0.0 ? (half + root) * u + uv * v : uv * u + (root - half) * v;
  Curvature out;
  out.max = static_cast<float>(std::max(0.0, mean + root));
  out.min = static_cast<float>(std::max(0.0, mean - root));
  if (root > 0.0) {
    const Eigen::Vector3f direction = along.normalized().cast<float>();
    out.direction = {direction.x(), direction.y(), direction.z()};
  }
  return out;
}

std::uint8_t signed_byte(float value) {
  return cv::saturate_cast<std::uint8_t>(kNeutral + 127.0F * value);
}

void write(const Curvature& curvature, int y, int x, std::vector<cv::Mat>& planes) {
  const auto put = [&](int plane, std::uint8_t value) {
    planes[static_cast<std::size_t>(plane)].at<std::uint8_t>(y, x) = value;
  };
  const float max = std::sqrt(curvature.max);
  const float min = std::sqrt(curvature.min);
  put(CurvatureLayout::kMax, cv::saturate_cast<std::uint8_t>(255.0F * max / CurvatureLayout::kFullSpread));
  put(CurvatureLayout::kMin, cv::saturate_cast<std::uint8_t>(255.0F * min / CurvatureLayout::kFullSpread));
  if (max > 0.0F) put(CurvatureLayout::kRatio, cv::saturate_cast<std::uint8_t>(255.0F * min / max));
  const float dx = curvature.direction[0];
  const float dy = curvature.direction[1];
  const float squared = dx * dx + dy * dy;
  if (squared > 0.0F) {
    const float distinct = (curvature.max - curvature.min) / (curvature.max + curvature.min);
    put(CurvatureLayout::kDirection, signed_byte(distinct * (dx * dx - dy * dy) / squared));
    put(CurvatureLayout::kDirection + 1, signed_byte(distinct * 2.0F * dx * dy / squared));
  }
}

}  // namespace

std::vector<Curvature> row_curvatures(const SurfaceVectors& normals, int y, int radius_px) {
  const std::vector<WindowMoments> moments = row_moments(normals, y, radius_px);
  std::vector<Curvature> row(moments.size(), {kNoValue, kNoValue, {kNoValue, kNoValue, kNoValue}});
  for (std::size_t x = 0; x < row.size(); ++x) {
    if (moments[x].count == 0) continue;
    const Eigen::Vector3d normal(normals.xyz[0].ptr<float>(y)[x], normals.xyz[1].ptr<float>(y)[x],
                                 normals.xyz[2].ptr<float>(y)[x]);
    row[x] = curvature_of(moments[x].covariance, normal);
  }
  return row;
}

std::vector<cv::Mat> curvature_planes(const WorkingFrame& frame, int threads) {
  const cv::Mat normals = surface_normals(frame, CurvatureLayout::kNormalNeighbours, threads);
  const SurfaceVectors vectors = normal_vectors(frame, normals);
  const int radius = surface_window_radius(CurvatureLayout::kNeighbours);
  std::vector<cv::Mat> planes(CurvatureLayout::kPlanes);
  for (int p = 0; p < CurvatureLayout::kPlanes; ++p) {
    const bool is_signed = p == CurvatureLayout::kDirection || p == CurvatureLayout::kDirection + 1;
    planes[static_cast<std::size_t>(p)] = cv::Mat(normals.size(), CV_8UC1, cv::Scalar(is_signed ? kNeutral : 0));
  }
  parallel_for(threads, normals.rows, [&](int y) {
    const std::vector<Curvature> row = row_curvatures(vectors, y, radius);
    for (int x = 0; x < normals.cols; ++x) {
      const Curvature& curvature = row[static_cast<std::size_t>(x)];
      if (!std::isnan(curvature.max)) write(curvature, y, x, planes);
    }
  });
  return planes;
}

}  // namespace houghstream::baseline
