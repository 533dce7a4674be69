#include "detector/features/patch_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace houghstream {
namespace {

constexpr int kSquareSide = 32;  // patches

/// Visits a place every `stride` pixels, square by square: the patches of a square share their pixels, so that a
/// square's worth of planes stays in the cache from tree to tree.
template <typename Visit>
void for_places(cv::Size size, int stride, const Visit& visit) {
  const int side = kSquareSide * stride;
  for (int top = stride / 2; top < size.height; top += side) {
    for (int left = stride / 2; left < size.width; left += side) {
      for (int y = top; y < std::min(size.height, top + side); y += stride) {
        for (int x = left; x < std::min(size.width, left + side); x += stride) visit(x, y);
      }
    }
  }
}

constexpr int kThinnings = 8;  // maximum number of thinnings: then patches stand 16 times as far apart

/// Returns how often a grid may be thinned out before this place is dropped. The remaining places alternate between a
/// chess board's black fields and rows and columns.
int thinnings_survived(int column, int row) {
  int halvings = 0;
  while (2 * halvings < kThinnings && ((column | row) >> halvings & 1) == 0) ++halvings;
  const bool black = ((column ^ row) >> halvings & 1) == 0;
  return std::min(kThinnings, 2 * halvings + (black ? 1 : 0));
}

/// Decides by depth how often the grid's places are thinned out: as often as patches on a surface that faces the camera
/// then stand at most PatchSpacing::metres apart.
class Thinning {
 public:
  Thinning(const PatchSpacing& spacing, const Camera& camera) {
    const double step_per_metre = spacing.stride * camera.metres_per_px(1.0);
    for (int t = 0; t < kThinnings; ++t) {
      farthest_[t] = static_cast<float>(spacing.metres / (step_per_metre * std::pow(2.0, 0.5 * (t + 1))));
    }
  }

  /// Returns whether a place that survives so many thinnings is kept at this depth.
  bool is_kept(int survived, float z) const { return survived == kThinnings || z > farthest_[survived]; }

  int count(float z) const {
    int t = 0;
    while (t < kThinnings && z <= farthest_[t]) ++t;
    return t;
  }

 private:
  std::array<float, kThinnings> farthest_{};  ///< depth up to which places are thinned out once more, metres
};

void reserve_places(cv::Size size, int stride, PatchGrid& grid) {
  const auto along = [&](int pixels) { return static_cast<std::size_t>((pixels + stride - 1) / stride); };
  const std::size_t count = grid.size() + along(size.width) * along(size.height);
  grid.level.reserve(count);
  grid.x.reserve(count);
  grid.y.reserve(count);
  grid.scale.reserve(count);
  grid.cell_px.reserve(count);
}

/// Place of a patch, with the side of the part of the image that it stands for, working pixels.
struct Place {
  int x;
  int y;
  float side;
};

void add_place(const Place& place, const FeatureLevel& level, std::uint8_t level_index, PatchGrid& grid) {
  const float to_frame = 1.0F / level.scale;
  const float side_px = place.side * to_frame;
  grid.level.push_back(level_index);
  grid.x.push_back(static_cast<std::int16_t>(place.x));
  grid.y.push_back(static_cast<std::int16_t>(place.y));
  const float left = (static_cast<float>(place.x) + 0.5F) * to_frame - 0.5F * side_px;
  const float top = (static_cast<float>(place.y) + 0.5F) * to_frame - 0.5F * side_px;
  grid.cell_px.emplace_back(left, top, side_px, side_px);
}

}  // namespace

void PatchGrid::clear() {
  level.clear();
  x.clear();
  y.clear();
  scale.clear();
  point_camera.clear();
  cell_px.clear();
  area.clear();
}

void add_patches(const WorkingFrame& frame, const FeatureLevel& level, std::uint8_t level_index,
                 const PatchLayout& layout, PatchGrid& grid) {
  const PatchSpacing& spacing = layout.spacing;
  const Thinning thinning(spacing, frame.camera);
  std::array<float, kThinnings + 1> sides{};  // working pixels between patches
  for (int t = 0; t <= kThinnings; ++t) sides[t] = static_cast<float>(spacing.stride * std::pow(2.0, 0.5 * t));
  const auto metres_per_px = static_cast<float>(frame.camera.metres_per_px(1.0));
  for_places(frame.filled_depth.size(), spacing.stride, [&](int x, int y) {
    const float z = frame.filled_depth.at<float>(y, x);
    if (!level.contains(z) || !thinning.is_kept(thinnings_survived(x / spacing.stride, y / spacing.stride), z)) return;
    const float side = sides[thinning.count(z)];
    const float side_metres = side * metres_per_px * z;
    add_place({x, y, side}, level, level_index, grid);
    grid.scale.push_back(patch_scale(layout.patch, frame.camera.fx, z));
    grid.point_camera.emplace_back(frame.camera.backproject(x, y, z).cast<float>());
    grid.area.push_back(side_metres * side_metres);
  });
}

void place_patches(const WorkingImages& images, const PatchLayout& layout, PatchGrid& grid) {
  grid.clear();
  grid.tiles.resize(images.levels.size());
  for (std::size_t level = 0; level < images.levels.size(); ++level) {
    const WorkingFrame& frame = images.frames[level];
    FeatureTiles& tiles = grid.tiles[level];
    const std::size_t first = grid.size();
    add_patches(frame, images.levels[level], static_cast<std::uint8_t>(level), layout, grid);
    tiles.clear(frame.colour.size());
    for (std::size_t p = first; p < grid.size(); ++p) {
      tiles.add_patch(grid.x[p], grid.y[p], max_offset(layout.patch, grid.scale[p]));
    }
  }
}

void add_patches_everywhere(const WorkingFrame& frame, const FeatureLevel& level, const PatchSettings& patch,
                            int stride, PatchGrid& grid) {
  const std::int32_t scale = limited_scale(patch, patch.unit);
  reserve_places(frame.filled_depth.size(), stride, grid);
  for_places(frame.filled_depth.size(), stride, [&](int x, int y) {
    add_place({x, y, static_cast<float>(stride)}, level, 0, grid);
    grid.scale.push_back(scale);
  });
}

void list_runs(const PatchGrid& patches, std::vector<PatchRun>& runs) {
  constexpr std::size_t kPatches = 512;
  runs.clear();
  for (std::size_t begin = 0; begin < patches.size();) {
    std::size_t end = begin;
    while (end < patches.size() && end - begin < kPatches && patches.level[end] == patches.level[begin]) ++end;
    runs.push_back({begin, end - begin});
    begin = end;
  }
}

}  // namespace houghstream
