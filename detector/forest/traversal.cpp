#include "detector/forest/traversal.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "detector/forest/square_forest.hpp"
#include "detector/forest/square_planes.hpp"
#include "detector/forest/square_walk.hpp"
#include "detector/forest/wide_walk.hpp"
#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

constexpr int kLanes = 8;  // patches in flight

/// Walks the patches down one tree, kLanes of them in step. Lanes that have arrived wait.
void walk_in_lanes(const Forest& forest, std::int32_t root, const WalkingPatches& patches, std::int32_t* leaves) {
  const TreeNode* nodes = forest.nodes.data();
  for (int begin = 0; begin < patches.count; begin += kLanes) {
    const auto lanes = static_cast<std::size_t>(std::min(kLanes, patches.count - begin));
    std::array<PatchView, kLanes> views{};
    std::array<std::int32_t, kLanes> at{};
    for (std::size_t l = 0; l < lanes; ++l) {
      const std::size_t p = static_cast<std::size_t>(begin) + l;
      views[l] = patches.image->patch(patches.x[p], patches.y[p], patches.scale[p]);
      at[l] = root;
    }
    bool walking = root >= 0;
    while (walking) {
      walking = false;
      for (std::size_t l = 0; l < lanes; ++l) {
        if (at[l] < 0) continue;
        const TreeNode& node = nodes[at[l]];
        at[l] = test_value(node.test, views[l]) >= node.test.threshold ? node.right : node.left;
        walking = walking || at[l] >= 0;
      }
    }
    for (std::size_t l = 0; l < lanes; ++l) leaves[static_cast<std::size_t>(begin) + l] = -1 - at[l];
  }
}

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

void reserve_places(cv::Size size, int stride, PatchGrid& grid) {
  const auto along = [&](int pixels) { return static_cast<std::size_t>((pixels + stride - 1) / stride); };
  const std::size_t count = grid.size() + along(size.width) * along(size.height);
  grid.level.reserve(count);
  grid.x.reserve(count);
  grid.y.reserve(count);
  grid.scale.reserve(count);
  grid.cell_px.reserve(count);
}

void add_place(int x, int y, const FeatureLevel& level, std::uint8_t level_index, int stride, PatchGrid& grid) {
  const float to_frame = 1.0F / level.scale;
  const float side_px = static_cast<float>(stride) * to_frame;
  grid.level.push_back(level_index);
  grid.x.push_back(static_cast<std::int16_t>(x));
  grid.y.push_back(static_cast<std::int16_t>(y));
  const float left = (static_cast<float>(x) + 0.5F) * to_frame - 0.5F * side_px;
  const float top = (static_cast<float>(y) + 0.5F) * to_frame - 0.5F * side_px;
  grid.cell_px.emplace_back(left, top, side_px, side_px);
}

/// Where for_places goes from square to square, at every pixel.
void list_squares(cv::Size size, PatchGrid& grid) {
  std::size_t first = 0;
  for (int top = 0; top < size.height; top += kSquareSide) {
    for (int left = 0; left < size.width; left += kSquareSide) {
      const int width = std::min(kSquareSide, size.width - left);
      const int height = std::min(kSquareSide, size.height - top);
      const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
      grid.squares.push_back({first, count, width});
      first += count;
    }
  }
}

/// Leaves of one run in all trees.
void walk_run(const Forest& forest, const FeatureImage& image, const PatchGrid& patches, const PatchRun& run,
              std::int32_t* leaves) {
  const WalkingPatches walking{&image, patches.x.data() + run.first, patches.y.data() + run.first,
                               patches.scale.data() + run.first, static_cast<int>(run.count)};
  for (std::size_t tree = 0; tree < forest.roots.size(); ++tree, leaves += run.count) {
    if (!walk_wide(forest, static_cast<int>(tree), walking, leaves)) {
      walk_in_lanes(forest, forest.roots[tree], walking, leaves);
    }
  }
}

/// The same for a square.
void walk_square_run(const SquareForest& forest, const FeatureImage& image, const PatchGrid& patches,
                     const PatchRun& run, std::int32_t* leaves) {
  static thread_local std::vector<std::uint8_t> planes;  // kept from square to square
  const PatchSquare square{patches.x[run.first], patches.y[run.first], run.width,
                           static_cast<int>(run.count) / run.width};
  copy_planes(image, square, forest.layout, planes);
  for (std::size_t tree = 0; tree < forest.roots.size(); ++tree, leaves += run.count) {
    walk_square(forest, static_cast<int>(tree), square, planes, leaves);
  }
}

}  // namespace

void add_patches(const WorkingFrame& frame, const FeatureLevel& level, std::uint8_t level_index,
                 const PatchSettings& patch, int stride, PatchGrid& grid) {
  const auto side_per_metre = static_cast<float>(stride * frame.camera.metres_per_px(1.0));
  for_places(frame.filled_depth.size(), stride, [&](int x, int y) {
    const float z = frame.filled_depth.at<float>(y, x);
    if (!level.holds(z)) return;
    add_place(x, y, level, level_index, stride, grid);
    grid.scale.push_back(patch_scale(patch, frame.camera.fx, z));
    grid.point_camera.emplace_back(frame.camera.backproject(x, y, z).cast<float>());
    grid.area.push_back(side_per_metre * z * side_per_metre * z);
  });
}

void add_patches_everywhere(const WorkingFrame& frame, const FeatureLevel& level, const PatchSettings& patch,
                            int stride, PatchGrid& grid) {
  const std::int32_t scale = limited_scale(patch, patch.unit);
  reserve_places(frame.filled_depth.size(), stride, grid);
  for_places(frame.filled_depth.size(), stride, [&](int x, int y) {
    add_place(x, y, level, 0, stride, grid);
    grid.scale.push_back(scale);
  });
  if (stride == 1) list_squares(frame.filled_depth.size(), grid);
}

std::vector<PatchRun> patch_runs(const PatchGrid& patches) {
  if (!patches.squares.empty()) return patches.squares;
  constexpr std::size_t kPatches = kSquareSide * kSquareSide;
  std::vector<PatchRun> runs;
  for (std::size_t begin = 0; begin < patches.size();) {
    std::size_t end = begin;
    while (end < patches.size() && end - begin < kPatches && patches.level[end] == patches.level[begin]) ++end;
    runs.push_back({begin, end - begin, 0});
    begin = end;
  }
  return runs;
}

void find_leaves(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                 const std::vector<PatchRun>& runs, int threads, const LeafVisitor& visit) {
  std::optional<SquareForest> for_squares;
  if (!patches.squares.empty()) for_squares.emplace(forest, patches.scale[0], features[0].pixel_stride());
  parallel_for(threads, static_cast<int>(runs.size()), [&](int r) {
    static thread_local std::vector<std::int32_t> leaves;  // kept from run to run
    const PatchRun& run = runs[static_cast<std::size_t>(r)];
    const FeatureImage& image = features[patches.level[run.first]];
    leaves.resize(run.count * forest.roots.size());
    if (for_squares) {
      walk_square_run(*for_squares, image, patches, run, leaves.data());
    } else {
      walk_run(forest, image, patches, run, leaves.data());
    }
    visit(static_cast<std::size_t>(r), leaves.data());
  });
}

void find_leaves_readably(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                          const std::vector<PatchRun>& runs, const LeafVisitor& visit) {
  for (std::size_t r = 0; r < runs.size(); ++r) {
    std::vector<std::int32_t> leaves(runs[r].count * forest.roots.size());
    for (std::size_t i = 0; i < runs[r].count; ++i) {
      const std::size_t p = runs[r].first + i;
      const PatchView patch = features[patches.level[p]].patch(patches.x[p], patches.y[p], patches.scale[p]);
      for (std::size_t tree = 0; tree < forest.roots.size(); ++tree) {
        leaves[tree * runs[r].count + i] = find_leaf(forest, static_cast<int>(tree), patch);
      }
    }
    visit(r, leaves.data());
  }
}

}  // namespace houghstream
