#pragma once

#include <cstdint>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/forest.hpp"

namespace houghstream {

/// The patches of a frame, level by level.
struct PatchGrid {
  std::vector<std::uint8_t> level;  ///< FeatureLevel whose FeatureImage the patch is looked at in
  std::vector<std::int16_t> x;      ///< working pixels of its level
  std::vector<std::int16_t> y;
  std::vector<std::int32_t> scale;            ///< patch_scale
  std::vector<Eigen::Vector3f> point_camera;  ///< the surface point seen at the centre, metres
  std::vector<cv::Rect2f> cell_px;            ///< the part of the frame that the patch stands for, frame pixels
  std::vector<float> area;                    ///< the same on the surface, facing the camera, square metres
  /// Patches first .. first + width * height - 1, row by row: neighbours of one scale, one at every pixel.
  struct Square {
    std::size_t first = 0;
    int width = 0;
    int height = 0;
  };
  std::vector<Square> squares;  ///< all patches, or none where they have gaps or several scales
  std::size_t size() const { return x.size(); }
};

/// Appends a patch every `stride` working pixels (paper, Section 5.1.3) whose depth the level holds, square by square.
void add_patches(const WorkingFrame& frame, const FeatureLevel& level, std::uint8_t level_index,
                 const PatchSettings& patch, int stride, PatchGrid& grid);

/// The same for a level of a scale space: every patch, whatever its depth; without points and areas.
void add_patches_everywhere(const WorkingFrame& frame, const FeatureLevel& level, const PatchSettings& patch,
                            int stride, PatchGrid& grid);

/// Leaf of every patch in every tree: element [patch * trees + tree]; `features` holds one image per level. Several
/// patches are walked at once, so that their cache misses overlap; the leaves are those of find_leaf.
std::vector<std::int32_t> assign_leaves(const Forest& forest, const std::vector<FeatureImage>& features,
                                        const PatchGrid& patches, int threads);

/// The same leaves, found one after another by find_leaf.
std::vector<std::int32_t> assign_leaves_readably(const Forest& forest, const std::vector<FeatureImage>& features,
                                                 const PatchGrid& patches);

}  // namespace houghstream
