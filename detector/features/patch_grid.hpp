#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "detector/features/feature_tiles.hpp"
#include "detector/features/patch_settings.hpp"
#include "detector/features/working_frame.hpp"

namespace houghstream {

/// Patches that are looked at together: all of one level, one after another in the grid.
struct PatchRun {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// The patches of a frame, level by level.
struct PatchGrid {
  std::vector<std::uint8_t> level;  ///< FeatureLevel whose FeatureImage the patch reads
  std::vector<std::int16_t> x;      ///< working pixels of its level
  std::vector<std::int16_t> y;
  std::vector<std::int32_t> scale;            ///< patch_scale
  std::vector<Eigen::Vector3f> point_camera;  ///< the surface point seen at the centre, metres
  std::vector<cv::Rect2f> cell_px;            ///< the part of the frame that the patch stands for, frame pixels
  std::vector<float> area;                    ///< area of that part on the surface, facing the camera, square metres
  std::vector<FeatureTiles> tiles;  ///< tiles that the patches of each level read; filled by place_patches only

  std::size_t size() const { return x.size(); }
  void clear();  ///< keeps the memory
};

/// Settings of the patches of a frame.
struct PatchLayout {
  PatchSettings patch;
  PatchSpacing spacing;
};

/// Appends the patches whose depth the level holds, square by square. They stand `stride` working pixels apart (paper,
/// Section 5.1.3); where that is nearer than `metres` on the surface, every other one is left out, again and again, as
/// long as the rest stand no farther apart: each time by a factor of sqrt(2). Which ones are left out depends on the
/// place and the depth there only.
void add_patches(const WorkingFrame& frame, const FeatureLevel& level, std::uint8_t level_index,
                 const PatchLayout& layout, PatchGrid& grid);

/// Places the patches of all levels of a frame, and marks the tiles that they read. `grid` is overwritten, and its
/// memory is reused.
void place_patches(const WorkingImages& images, const PatchLayout& layout, PatchGrid& grid);

/// Adds a patch every `stride` pixels, whatever its depth, without points and areas: for a level of a scale space.
void add_patches_everywhere(const WorkingFrame& frame, const FeatureLevel& level, const PatchSettings& patch,
                            int stride, PatchGrid& grid);

/// Divides the grid into runs small enough for their pixels to stay in the cache from tree to tree.
void list_runs(const PatchGrid& patches, std::vector<PatchRun>& runs);

}  // namespace houghstream
