#include "pose/reconstruction/selection/support_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "pose/reconstruction/map/frame_levels.hpp"

namespace houghstream::reconstruction {
namespace {

constexpr double kHalfExtent_m = 0.8;  // half the side of the searched part of the plane

/// Returns the cell of the plane below each pixel above it; (-1,-1) for the others.
cv::Mat cells_of_pixels(const RgbdFrame& frame, const Plane& plane, const PlaneAxes& axes, const SearchRegion& searched,
                        cv::Mat& grid) {
  constexpr double kMin_m = 0.006;  // lower points are taken for the plane
  constexpr double kMax_m = 0.75;
  const cv::Rect& region = searched.region_px;
  cv::Mat cells(frame.depth.size(), CV_32SC2, cv::Scalar(-1, -1));
  grid = cv::Mat::zeros(PlaneAxes::cells(), PlaneAxes::cells(), CV_8UC1);
  for (int y = region.y; y < region.br().y; ++y) {
    for (int x = region.x; x < region.br().x; ++x) {
      const float z = frame.depth.at<float>(y, x);
      if (!(z > 0.1F && z < searched.max_distance_m)) continue;
      const Eigen::Vector3d p = frame.camera.backproject(x, y, z);
      const double height = plane.signedDistance(p);
      if (height < std::max(kMin_m, 3.0 * depth_sigma(z)) || height > kMax_m) continue;
      const auto cell = axes.cell_of(p);
      if (!cell) continue;
      cells.at<cv::Vec2i>(y, x) = {cell->x, cell->y};
      grid.at<std::uint8_t>(*cell) = 255;
    }
  }
  return cells;
}

}  // namespace

PlaneAxes::PlaneAxes(const Plane& plane, const Eigen::Vector3d& middle_ray) {
  const double along = plane.normal().dot(middle_ray);
  const double z = along < -1e-3 ? std::min(-plane.offset() / along, 3.0) : 3.0;
  const Eigen::Vector3d ahead = z * middle_ray;
  origin = ahead - plane.signedDistance(ahead) * plane.normal();
  x = (Eigen::Vector3d::UnitX() - plane.normal().x() * plane.normal()).normalized();
  y = plane.normal().cross(x);
}

std::optional<cv::Point> PlaneAxes::cell_of(const Eigen::Vector3d& point) const {
  const int u = static_cast<int>(std::floor((x.dot(point - origin) + kHalfExtent_m) / kCell_m));
  const int v = static_cast<int>(std::floor((y.dot(point - origin) + kHalfExtent_m) / kCell_m));
  if (u < 1 || v < 1 || u >= cells() - 1 || v >= cells() - 1) return std::nullopt;
  return cv::Point(u, v);
}

Eigen::Vector3d PlaneAxes::point_at(double u, double v) const {
  return origin + (u * kCell_m - kHalfExtent_m) * x + (v * kCell_m - kHalfExtent_m) * y;
}

int PlaneAxes::cells() {
  return static_cast<int>(std::lround(2 * kHalfExtent_m / kCell_m));
}

Clusters find_clusters(const RgbdFrame& frame, const Plane& plane, const PlaneAxes& axes,
                       const SearchRegion& searched) {
  cv::Mat grid, joined, cell_labels;
  const cv::Mat cells = cells_of_pixels(frame, plane, axes, searched, grid);
  cv::dilate(grid, joined, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  Clusters found;
  found.clusters.resize(static_cast<std::size_t>(cv::connectedComponents(joined, cell_labels, 8, CV_32S)));
  found.labels = cv::Mat::zeros(frame.depth.size(), CV_32SC1);
  const cv::Point2d& target = searched.target_px;
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x) {
      const auto& cell = cells.at<cv::Vec2i>(y, x);
      if (cell[0] < 0) continue;
      const int label = cell_labels.at<int>(cell[1], cell[0]);
      found.labels.at<int>(y, x) = label;
      Cluster& cluster = found.clusters[static_cast<std::size_t>(label)];
      const double height = plane.signedDistance(frame.camera.backproject(x, y, frame.depth.at<float>(y, x)));
      ++cluster.pixels;
      cluster.lowest = std::min(cluster.lowest, height);
      cluster.highest = std::max(cluster.highest, height);
      cluster.target_distance_px = std::min(cluster.target_distance_px, std::hypot(x - target.x, y - target.y));
      cluster.cells =
          cluster.cells.empty() ? cv::Rect(cell[0], cell[1], 1, 1) : cluster.cells | cv::Rect(cell[0], cell[1], 1, 1);
    }
  }
  return found;
}

}  // namespace houghstream::reconstruction
