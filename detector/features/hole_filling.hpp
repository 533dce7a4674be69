#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

namespace houghstream {

/// Maximum distance between a hole's pixel and the measured depth that fills it.
struct HoleReach {
  float px = 0.0F;  ///< reach from any surface, pixels
  /// ... and from one at depth z as many pixels divided by z, where that is more. 0: what is nearest in pixels lends.
  float px_at_1m = 0.0F;
};

/// A pixel without depth.
struct Hole {
  std::int16_t x = 0;
  std::int16_t y = 0;
};

/// Workspace of fill_holes(), reused from image to image.
struct HoleWorkspace {
  std::vector<Hole> holes;  ///< row by row
  /// Distance to the pixel that a hole has borrowed from; 0 where there is no hole.
  std::vector<std::int32_t> distances;
};

/// Fills NaN pixels of a depth image (CV_32FC1, metres) with the nearest measured depth within reach. With `px_at_1m`
/// the nearest is at the smallest distance in metres on the lender's surface, pixels times its depth: a
/// structured-light camera loses near surfaces, and what lies in their shadow, before it loses what is behind them, so
/// that a hole between the two is more likely part of the near one. Distances are those of the 5x5 chamfer mask
/// (Borgefors 1986), within 2 % of the true ones. The time taken grows with the number of holes.
void fill_holes(cv::Mat& depth, const HoleReach& reach, HoleWorkspace& workspace);

inline void fill_holes(cv::Mat& depth, const HoleReach& reach) {
  HoleWorkspace workspace;
  fill_holes(depth, reach, workspace);
}

}  // namespace houghstream
