#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "pose/reconstruction/selection/support_planes.hpp"

namespace houghstream::reconstruction {

/// Coordinates in a plane, and cells of it; camera frame, metres.
struct PlaneAxes {
  static constexpr double kCell_m = 0.005;  ///< side of a cell, in which connected components are found

  Eigen::Vector3d origin, x, y;

  /// Makes axes about the point at which the camera looks along a ray, x to the camera's right.
  PlaneAxes(const Plane& plane, const Eigen::Vector3d& middle_ray);

  /// Returns the cell that a point is above; none where that is too far from the origin.
  std::optional<cv::Point> cell_of(const Eigen::Vector3d& point) const;
  /// Returns the point of the plane at a position in cells.
  Eigen::Vector3d point_at(double u, double v) const;
  /// Returns the number of cells of a side.
  static int cells();
};

/// Holds a connected component above the plane.
struct Cluster {
  int pixels = 0;
  double lowest = 1e9, highest = 0.0;  ///< above the plane, metres
  double target_distance_px = 1e9;     ///< distance of its nearest pixel from the target
  cv::Rect cells;
};

struct Clusters {
  cv::Mat labels;                 ///< cluster of each pixel, an index into `clusters`; CV_32SC1, size of the frame
  std::vector<Cluster> clusters;  ///< the first stands for none
};

/// Region of an image that is searched.
struct SearchRegion {
  cv::Rect region_px;           ///< within the image
  cv::Point2d target_px;        ///< pixel on or near the object that is to be selected
  double max_distance_m = 0.0;  ///< maximum distance from the camera
};

/// Finds clusters of points above a plane.
Clusters find_clusters(const RgbdFrame& frame, const Plane& plane, const PlaneAxes& axes, const SearchRegion& searched);

}  // namespace houghstream::reconstruction
