#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <opencv2/core/types.hpp>
#include <vector>

#include "detector/baseline/point_histogram_settings.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream::baseline {

/// The points that get a histogram, one per cell of step_px x step_px pixels, row by row.
struct HistogramCloud {
  cv::Size size;  ///< points
  int step_px = 1;
  std::vector<float> reaches;             ///< reaches of neighbours in the image, points
  float limit = 0.0F;                     ///< see same_surface_limit
  pcl::PointCloud<pcl::PointXYZ> points;  ///< NaN where there is no surface
  pcl::PointCloud<pcl::Normal> normals;
  std::vector<std::vector<cv::Point>> shifts;  ///< shifts to the neighbours, for each reach in steps of kReachStep

  static constexpr float kReachStep = 0.25F;
  static constexpr float kMaxDistance = 16.0F;  ///< reach; of what is nearer than that the support is cut off

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * size.width + x); }
};

struct CloudNeighbours {
  pcl::Indices indices;
  std::vector<float> distances_sq;  ///< metres^2
};

HistogramCloud make_histogram_cloud(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads);

/// Lists the neighbours of a point on its surface, the point first; none where there is no surface.
CloudNeighbours neighbours_of(const HistogramCloud& cloud, int x, int y);

}  // namespace houghstream::baseline
