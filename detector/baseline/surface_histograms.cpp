#include "detector/baseline/surface_histograms.hpp"

#include <pcl/features/fpfh.h>
#include <pcl/features/pfh.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <cmath>

#include "detector/baseline/surface_neighbours.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream::baseline {

namespace {

/// Calls visit(index of the point, its neighbours) for every point that has any.
template <typename Visit>
void visit_row(const HistogramCloud& cloud, int y, const Visit& visit) {
  for (int x = 0; x < cloud.size.width; ++x) {
    const CloudNeighbours near = neighbours_of(cloud, x, y);
    if (near.indices.size() > 1) visit(cloud.index(x, y), near);
  }
}

/// Planes from one column of percentages per point of the cloud.
std::vector<cv::Mat> spread(const HistogramCloud& cloud, const Eigen::MatrixXf& percent, const cv::Mat& depth,
                            int threads) {
  std::vector<cv::Mat> planes(static_cast<std::size_t>(percent.rows()));
  for (cv::Mat& plane : planes) plane = cv::Mat::zeros(depth.size(), CV_8UC1);
  parallel_for(threads, depth.rows, [&](int y) {
    const auto* z = depth.ptr<float>(y);
    for (int x = 0; x < depth.cols; ++x) {
      const std::size_t i = cloud.index(x / cloud.step_px, y / cloud.step_px);
      if (!(std::fabs(z[x] - cloud.points[i].z) < cloud.limit)) continue;
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
  const HistogramCloud cloud = make_histogram_cloud(frame, settings, threads);
  const auto count = static_cast<Eigen::Index>(cloud.points.size());
  Eigen::MatrixXf first = Eigen::MatrixXf::Zero(count, settings.fpfh_bins);
  Eigen::MatrixXf second = first;
  Eigen::MatrixXf third = first;
  parallel_for(threads, cloud.size.height, [&](int y) {
    Estimation estimation;
    visit_row(cloud, y, [&](std::size_t i, const CloudNeighbours& near) {
      const auto row = static_cast<pcl::index_t>(i);
      estimation.computePointSPFHSignature(cloud.points, cloud.normals, row, row, near.indices, first, second, third);
    });
  });
  Eigen::MatrixXf percent = Eigen::MatrixXf::Zero(3 * settings.fpfh_bins, count);
  parallel_for(threads, cloud.size.height, [&](int y) {
    Estimation estimation;
    Eigen::VectorXf histogram;
    visit_row(cloud, y, [&](std::size_t i, const CloudNeighbours& near) {
      estimation.weightPointSPFHSignature(first, second, third, near.indices, near.distances_sq, histogram);
      percent.col(static_cast<Eigen::Index>(i)) = histogram;
    });
  });
  return spread(cloud, percent, frame.filled_depth, threads);
}

std::vector<cv::Mat> pfh_planes(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads) {
  const HistogramCloud cloud = make_histogram_cloud(frame, settings, threads);
  const int bins = settings.pfh_bins * settings.pfh_bins * settings.pfh_bins;
  Eigen::MatrixXf percent = Eigen::MatrixXf::Zero(bins, static_cast<Eigen::Index>(cloud.points.size()));
  parallel_for(threads, cloud.size.height, [&](int y) {
    pcl::PFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::PFHSignature125> estimation;
    Eigen::VectorXf histogram(bins);
    visit_row(cloud, y, [&](std::size_t i, const CloudNeighbours& near) {
      estimation.computePointPFHSignature(cloud.points, cloud.normals, near.indices, settings.pfh_bins, histogram);
      percent.col(static_cast<Eigen::Index>(i)) = histogram;
    });
  });
  return spread(cloud, percent, frame.filled_depth, threads);
}

}  // namespace houghstream::baseline
