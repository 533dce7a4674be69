#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/working_frame.hpp"

namespace houghstream::baseline {

/// Histogram of Oriented Normal Vectors (Tang et al. 2013; paper, Section 3, item 5) with the sizes of Section 4: 120
/// neighbours for the normals and for the histogram, in the organised image.
struct HonvLayout {
  static constexpr int kNeighbours = 120;
  static constexpr int kAzimuths = 4;  ///< the normal points right, down, left, up in the image
  static constexpr int kZeniths = 3;   ///< it leaves the optical axis by about 15, 45, 75 degrees
  static constexpr int kPlanes = kAzimuths * kZeniths;
  static constexpr int plane(int azimuth, int zenith) { return zenith * kAzimuths + azimuth; }
};

/// Computes kPlanes planes CV_8UC1: the fraction of each bin among the normals around a pixel, 255 for all of them. A
/// normal is divided linearly between the nearest bins of both angles; between 15 and 0 degrees from the axis its
/// azimuth fades to all four alike, since a surface seen face on has none. 0 in all planes where there is no normal.
std::vector<cv::Mat> honv_planes(const WorkingFrame& frame, int threads);

}  // namespace houghstream::baseline
