#pragma once

namespace houghstream::baseline {

/// (Fast) Point Feature Histograms (Rusu et al. 2008 and 2009; paper, Section 3, item 7): PCL's functions, given the
/// neighbours that the organised image knows instead of those of a search. Neighbours are counted as in a cloud with
/// a point every `spacing` metres: with the image's own, supports would grow with the distance, and a larger object
/// farther away would look the same.
struct PointHistogramSettings {
  float spacing = 0.0035F;      ///< metres; supports are disks of 28 and 20 mm then
  int neighbours = 200;         ///< neighbours on the same surface (Section 4)
  int normal_neighbours = 100;  ///< neighbours for the normals (Section 4)
  int given = 48;   ///< neighbours that stand for all; the cost of FPFH grows with them, that of PFH with their square
  int step_px = 4;  ///< pixels from one point that gets a histogram to the next
  int fpfh_bins = 11;  ///< per angle; PCL's default. The paper's histogram size is 7
  int pfh_bins = 5;    ///< per angle; PCL's default
};

}  // namespace houghstream::baseline
