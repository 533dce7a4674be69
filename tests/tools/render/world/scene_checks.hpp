#pragma once

#include <algorithm>
#include <limits>
#include <opencv2/core.hpp>

#include "tools/render/world/objects/world.hpp"

namespace houghstream::world {

/// Returns the height of the lowest vertex of an asset in its world, metres.
inline double lowest_point(const PlacedAsset& placed) {
  double z = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3f& vertex : placed.thing->mesh.vertices)
    z = std::min(z, (placed.T_world_object * vertex.cast<double>()).z());
  return z;
}

/// Returns whether two images without gaps between their rows are the same byte for byte, NaN included.
inline bool identical(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && std::equal(a.datastart, a.dataend, b.datastart);
}

}  // namespace houghstream::world
