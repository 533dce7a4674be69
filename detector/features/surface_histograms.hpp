#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/working_frame.hpp"

namespace houghstream {

/// (Fast) Point Feature Histograms (Rusu et al. 2008 and 2009; paper, Section 3, item 7): PCL's functions, given the
/// neighbours that the organised image knows instead of those of a search. They see a cloud of every step_px-th pixel
/// both ways, the middle one of each cell; its points have neighbours / step_px^2 neighbours, so that the support stays
/// that of `neighbours` pixels.
struct PointHistogramSettings {
  int step_px = 2;              ///< pixels; the cost of FPFH falls with its 4th power, that of PFH with its 6th
  int neighbours = 200;         ///< pixels; the nearest in the picture that lie on the same surface (Section 4)
  int normal_neighbours = 100;  ///< pixels, for the normals (Section 4)
  int fpfh_bins = 11;           ///< per angle; PCL's default. The paper's histogram size is 7
  int pfh_bins = 5;             ///< per angle; PCL's default
};

/// CV_8UC1 planes of the frame's size, each pixel with the values of its cell, 255 for 100 percent. All are 0 where the
/// pixel or the middle of its cell has no surface, or where these are not the same one.

/// 3 x fpfh_bins planes: one histogram for each of the three angles between pairs of normals.
std::vector<cv::Mat> fpfh_planes(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads);

/// pfh_bins^3 planes: one histogram of the three angles together.
std::vector<cv::Mat> pfh_planes(const WorkingFrame& frame, const PointHistogramSettings& settings, int threads);

}  // namespace houghstream
