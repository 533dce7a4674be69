#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <opencv2/core.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

#include "detector/features/working_frame.hpp"

namespace houghstream::baseline {

/// (Fast) Point Feature Histograms (Rusu et al. 2008 and 2009; paper, Section 3, item 7): PCL's functions, given the
/// neighbours that the organised image knows instead of those of a search. Neighbours are counted as in a cloud with
/// a point every `spacing` metres: with the image's own, supports would grow with the distance, and a larger object
/// farther away would look the same.
struct PointHistogramSettings {
  float spacing = 0.0035F;      ///< metres; supports are disks of 28 and 20 mm then
  int neighbours = 200;         ///< those that lie on the same surface (Section 4)
  int normal_neighbours = 100;  ///< for the normals (Section 4)
  int given = 48;   ///< neighbours that stand for all; the cost of FPFH grows with them, that of PFH with their square
  int step_px = 4;  ///< pixels from one point that gets a histogram to the next
  int fpfh_bins = 11;  ///< per angle; PCL's default. The paper's histogram size is 7
  int pfh_bins = 5;    ///< per angle; PCL's default
};

/// CV_8UC1 planes of the frame's size, each pixel with the values of its cell, 255 for 100 percent. All are 0 where the
/// pixel or the middle of its cell has no surface, or where these are not the same one.

/// 3 x fpfh_bins planes: one histogram for each of the three angles between pairs of normals.
std::vector<cv::Mat> fpfh_planes(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads);

/// pfh_bins^3 planes: one histogram of the three angles together.
std::vector<cv::Mat> pfh_planes(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads);

/// The points that get a histogram, one per cell of step_px x step_px pixels, row by row.
struct HistogramCloud {
  cv::Size size;  ///< points
  int step_px = 1;
  std::vector<float> reaches;             ///< how far neighbours lie in the picture, points
  float limit = 0.0F;                     ///< see same_surface_limit
  pcl::PointCloud<pcl::PointXYZ> points;  ///< NaN where there is no surface
  pcl::PointCloud<pcl::Normal> normals;
  std::vector<std::vector<cv::Point>> shifts;  ///< to the neighbours, for each reach in steps of kReachStep

  static constexpr float kReachStep = 0.25F;
  static constexpr float kFarthest = 16.0F;  ///< reach; of what is nearer than that the support is cut off

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * size.width + x); }
};

struct CloudNeighbours {
  pcl::Indices indices;
  std::vector<float> distances_sq;  ///< metres^2
};

HistogramCloud make_histogram_cloud(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads);

/// Those of a point that lie on its own surface, itself first; none where there is no surface.
CloudNeighbours neighbours_of(const HistogramCloud& cloud, int x, int y);

}  // namespace houghstream::baseline
