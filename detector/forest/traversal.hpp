#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/features/working_frame.hpp"
#include "detector/forest/forest.hpp"

namespace houghstream {

/// Patches that are looked at together: all of one level, one after another in the grid.
struct PatchRun {
  std::size_t first = 0;
  std::size_t count = 0;
  int width = 0;  ///< of a square: rows of so many neighbours of one scale, one at every pixel; else 0
};

/// The patches of a frame, level by level.
struct PatchGrid {
  std::vector<std::uint8_t> level;  ///< FeatureLevel whose FeatureImage the patch is looked at in
  std::vector<std::int16_t> x;      ///< working pixels of its level
  std::vector<std::int16_t> y;
  std::vector<std::int32_t> scale;            ///< patch_scale
  std::vector<Eigen::Vector3f> point_camera;  ///< the surface point seen at the centre, metres
  std::vector<cv::Rect2f> cell_px;            ///< the part of the frame that the patch stands for, frame pixels
  std::vector<float> area;                    ///< the same on the surface, facing the camera, square metres
  std::vector<PatchRun> squares;              ///< all patches, or none where they have gaps or several scales
  std::size_t size() const { return x.size(); }
};

/// Appends a patch every `stride` working pixels (paper, Section 5.1.3) whose depth the level holds, square by square.
void add_patches(const WorkingFrame& frame, const FeatureLevel& level, std::uint8_t level_index,
                 const PatchSettings& patch, int stride, PatchGrid& grid);

/// The same for a level of a scale space: every patch, whatever its depth; without points and areas.
void add_patches_everywhere(const WorkingFrame& frame, const FeatureLevel& level, const PatchSettings& patch,
                            int stride, PatchGrid& grid);

/// The grid in runs small enough for their pixels to stay in the cache from tree to tree: its squares where it has
/// some.
std::vector<PatchRun> patch_runs(const PatchGrid& patches);

/// Is told the leaves of a run's patches, tree by tree: leaves[tree * count + i] is that of patch first + i.
using LeafVisitor = std::function<void(std::size_t run, const std::int32_t* leaves)>;

/// Leaf of every patch in every tree; `features` holds one image per level. Patches are walked many at once, and runs
/// are visited at the same time; the leaves are those of find_leaf.
void find_leaves(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                 const std::vector<PatchRun>& runs, int threads, const LeafVisitor& visit);

/// The same leaves, found one after another by find_leaf.
void find_leaves_readably(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                          const std::vector<PatchRun>& runs, const LeafVisitor& visit);

}  // namespace houghstream
