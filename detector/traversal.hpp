#pragma once

#include <cstdint>
#include <vector>

#include "detector/feature_image.hpp"
#include "detector/forest.hpp"
#include "detector/working_frame.hpp"

namespace houghstream {

/// The patches of a frame: every `stride` working pixels where depth is known (paper, Section 5.1.3).
struct PatchGrid {
  std::vector<std::int16_t> x;  ///< working pixels
  std::vector<std::int16_t> y;
  std::vector<std::int32_t> scale;            ///< patch_scale
  std::vector<Eigen::Vector3f> point_camera;  ///< the surface point seen at the centre, metres
  std::size_t size() const { return x.size(); }
};
PatchGrid make_patch_grid(const WorkingFrame& frame, const PatchSettings& patch, int stride);

/// Leaf of every patch in every tree: element [patch * trees + tree]. Several patches are walked at once, so that
/// their cache misses overlap; the leaves are those of find_leaf.
std::vector<std::int32_t> assign_leaves(const Forest& forest, const FeatureImage& features, const PatchGrid& patches,
                                        int threads);

}  // namespace houghstream
