#include "detector/features/surface_histograms.hpp"

#include <pcl/features/fpfh.h>
#include <pcl/features/pfh.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "detector/features/surface_normals.hpp"
#include "pipeline/parallel.hpp"

namespace houghstream {

namespace {

/// Every step-th pixel as a cloud, row by row, with what is near to what.
struct Grid {
  cv::Size size;  ///< points
  int step_px = 1;
  std::vector<cv::Point> shifts;  ///< to the neighbours, nearest first; the point itself is the first
  std::vector<float> limits;      ///< metres of depth, per point; NaN where there is no surface
  pcl::PointCloud<pcl::PointXYZ> points;
  pcl::PointCloud<pcl::Normal> normals;

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * size.width + x); }
};

struct Neighbours {
  pcl::Indices indices;
  std::vector<float> distances_sq;  ///< metres^2
};

std::vector<cv::Point> nearest_shifts(int count) {
  const int reach = static_cast<int>(std::sqrt(static_cast<double>(count))) + 1;
  std::vector<cv::Point> shifts;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) shifts.emplace_back(x, y);
  }
  const auto rank = [](const cv::Point& p) { return std::make_tuple(p.dot(p), p.y, p.x); };
  std::sort(shifts.begin(), shifts.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  shifts.resize(static_cast<std::size_t>(count));
  return shifts;
}

Grid make_grid(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads) {
  const cv::Mat normals = surface_normals(frame, settings.normal_neighbours, threads);
  Grid grid;
  grid.step_px = settings.step_px;
  grid.size = {(normals.cols + grid.step_px - 1) / grid.step_px, (normals.rows + grid.step_px - 1) / grid.step_px};
  grid.shifts = nearest_shifts(std::max(1, settings.neighbours / (grid.step_px * grid.step_px)));
  const int radius = surface_window_radius(settings.neighbours);
  for (int gy = 0; gy < grid.size.height; ++gy) {
    for (int gx = 0; gx < grid.size.width; ++gx) {
      const int x = std::min(gx * grid.step_px + grid.step_px / 2, normals.cols - 1);
      const int y = std::min(gy * grid.step_px + grid.step_px / 2, normals.rows - 1);
      const float depth = frame.filled_depth.at<float>(y, x);
      const auto normal = normals.at<cv::Vec3f>(y, x);
      const Eigen::Vector3f point = frame.camera.backproject(x, y, depth).cast<float>();
      grid.points.emplace_back(point.x(), point.y(), point.z());
      grid.normals.emplace_back(normal[0], normal[1], normal[2]);
      grid.limits.push_back(std::isnan(normal[2]) ? normal[2] : same_surface_limit(frame.camera, depth, radius));
    }
  }
  return grid;
}

Neighbours neighbours_of(const Grid& grid, int x, int y) {
  Neighbours found;
  const std::size_t middle = grid.index(x, y);
  if (std::isnan(grid.limits[middle])) return found;
  for (const cv::Point& shift : grid.shifts) {
    const cv::Point at = cv::Point(x, y) + shift;
    if (at.x < 0 || at.y < 0 || at.x >= grid.size.width || at.y >= grid.size.height) continue;
    const std::size_t i = grid.index(at.x, at.y);
    const Eigen::Vector3f apart = grid.points[i].getVector3fMap() - grid.points[middle].getVector3fMap();
    if (std::isnan(grid.limits[i]) || !(std::fabs(apart.z()) < grid.limits[middle])) continue;
    found.indices.push_back(static_cast<pcl::index_t>(i));
    found.distances_sq.push_back(apart.squaredNorm());
  }
  return found;
}

/// visit(index of the point, its neighbours) for every point that has any.
template <typename Visit>
void visit_row(const Grid& grid, int y, const Visit& visit) {
  for (int x = 0; x < grid.size.width; ++x) {
    const Neighbours near = neighbours_of(grid, x, y);
    if (near.indices.size() > 1) visit(grid.index(x, y), near);
  }
}

/// Planes from one column of percentages per point of the grid.
std::vector<cv::Mat> spread(const Grid& grid, const Eigen::MatrixXf& percent, const cv::Mat& depth, int threads) {
  std::vector<cv::Mat> planes(static_cast<std::size_t>(percent.rows()));
  for (cv::Mat& plane : planes) plane = cv::Mat::zeros(depth.size(), CV_8UC1);
  parallel_for(threads, depth.rows, [&](int y) {
    const auto* z = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      const std::size_t i = grid.index(x / grid.step_px, y / grid.step_px);
      if (!(std::fabs(z[x] - grid.points[i].z) < grid.limits[i])) continue;
      for (std::size_t p = 0; p < planes.size(); ++p) {
        const float value = percent(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(i));
        planes[p].ptr<std::uint8_t>(y)[x] = cv::saturate_cast<std::uint8_t>(2.55F * value);
      }
    }
  });
  return planes;
}

}  // namespace

std::vector<cv::Mat> fpfh_planes(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads) {
  using Estimation = pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33>;
  const Grid grid = make_grid(frame, settings, threads);
  const auto count = static_cast<Eigen::Index>(grid.points.size());
  Eigen::MatrixXf first = Eigen::MatrixXf::Zero(count, settings.fpfh_bins);
  Eigen::MatrixXf second = first;
  Eigen::MatrixXf third = first;
  parallel_for(threads, grid.size.height, [&](int y) {
    Estimation estimation;
    visit_row(grid, y, [&](std::size_t i, const Neighbours& near) {
      const auto row = static_cast<pcl::index_t>(i);
      estimation.computePointSPFHSignature(grid.points, grid.normals, row, row, near.indices, first, second, third);
    });
  });
  Eigen::MatrixXf percent = Eigen::MatrixXf::Zero(3 * settings.fpfh_bins, count);
  parallel_for(threads, grid.size.height, [&](int y) {
    Estimation estimation;
    Eigen::VectorXf histogram;
    visit_row(grid, y, [&](std::size_t i, const Neighbours& near) {
      estimation.weightPointSPFHSignature(first, second, third, near.indices, near.distances_sq, histogram);
      percent.col(static_cast<Eigen::Index>(i)) = histogram;
    });
  });
  return spread(grid, percent, frame.filled_depth, threads);
}

std::vector<cv::Mat> pfh_planes(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads) {
  const Grid grid = make_grid(frame, settings, threads);
  const int bins = settings.pfh_bins * settings.pfh_bins * settings.pfh_bins;
  Eigen::MatrixXf percent = Eigen::MatrixXf::Zero(bins, static_cast<Eigen::Index>(grid.points.size()));
  parallel_for(threads, grid.size.height, [&](int y) {
    pcl::PFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::PFHSignature125> estimation;
    Eigen::VectorXf histogram(bins);
    visit_row(grid, y, [&](std::size_t i, const Neighbours& near) {
      estimation.computePointPFHSignature(grid.points, grid.normals, near.indices, settings.pfh_bins, histogram);
      percent.col(static_cast<Eigen::Index>(i)) = histogram;
    });
  });
  return spread(grid, percent, frame.filled_depth, threads);
}

}  // namespace houghstream
