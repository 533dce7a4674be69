#include "detector/forest/traversal.hpp"

#include <algorithm>
#include <array>

#include "detector/forest/square_forest.hpp"
#include "detector/forest/square_planes.hpp"
#include "detector/forest/square_walk.hpp"
#include "detector/forest/wide_walk.hpp"
#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

constexpr int kLanes = 8;    // patches in flight

/// Walks the patches down one tree, kLanes of them in step. Lanes that have arrived wait.
void walk_in_lanes(const Forest& forest, std::int32_t root, const WalkingPatches& patches, std::size_t step,
                   std::int32_t* leaves) {
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
    for (std::size_t l = 0; l < lanes; ++l) leaves[(static_cast<std::size_t>(begin) + l) * step] = -1 - at[l];
  }
}

/// Patches of one level: their pixels stay in the cache from tree to tree.
struct Band {
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::vector<Band> make_bands(const PatchGrid& patches) {
  constexpr std::size_t kPatches = kSquareSide * kSquareSide;
  std::vector<Band> bands;
  for (std::size_t begin = 0; begin < patches.size();) {
    std::size_t end = begin;
    while (end < patches.size() && end - begin < kPatches && patches.level[end] == patches.level[begin]) ++end;
    bands.push_back({begin, end});
    begin = end;
  }
  return bands;
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
      grid.squares.push_back({first, width, height});
      first += static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
  }
}

/// Square by square, for patches that all have one scale.
std::vector<std::int32_t> walk_squares(const Forest& forest, const FeatureImage& image, const PatchGrid& patches,
                                       int threads) {
  const std::size_t trees = forest.roots.size();
  std::vector<std::int32_t> leaves(patches.size() * trees);
  const SquareForest ready(forest, patches.scale[0], image.pixel_stride());
  parallel_for(threads, static_cast<int>(patches.squares.size()), [&](int s) {
    static thread_local std::vector<std::uint8_t> planes;
    const PatchGrid::Square& found = patches.squares[static_cast<std::size_t>(s)];
    const PatchSquare square{patches.x[found.first], patches.y[found.first], found.width, found.height};
    copy_planes(image, square, ready.layout, planes);
    std::vector<std::int32_t> reached(static_cast<std::size_t>(square.width * square.height));
    for (std::size_t tree = 0; tree < trees; ++tree) {
      walk_square(ready, static_cast<int>(tree), square, planes, reached.data());
      for (std::size_t i = 0; i < reached.size(); ++i) leaves[(found.first + i) * trees + tree] = reached[i];
    }
  });
  return leaves;
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
  for_places(frame.filled_depth.size(), stride, [&](int x, int y) {
    add_place(x, y, level, 0, stride, grid);
    grid.scale.push_back(scale);
  });
  if (stride == 1) list_squares(frame.filled_depth.size(), grid);
}

std::vector<std::int32_t> assign_leaves(const Forest& forest, const std::vector<FeatureImage>& features,
                                        const PatchGrid& patches, int threads) {
  if (!patches.squares.empty()) return walk_squares(forest, features[0], patches, threads);
  const std::size_t trees = forest.roots.size();
  std::vector<std::int32_t> leaves(patches.size() * trees);
  const std::vector<Band> bands = make_bands(patches);
  parallel_for(threads, static_cast<int>(bands.size()), [&](int b) {
    const Band& band = bands[static_cast<std::size_t>(b)];
    const WalkingPatches walking{&features[patches.level[band.begin]], patches.x.data() + band.begin,
                                 patches.y.data() + band.begin, patches.scale.data() + band.begin,
                                 static_cast<int>(band.end - band.begin)};
    for (std::size_t tree = 0; tree < trees; ++tree) {
      std::int32_t* out = leaves.data() + band.begin * trees + tree;
      if (!walk_wide(forest, static_cast<int>(tree), walking, trees, out)) {
        walk_in_lanes(forest, forest.roots[tree], walking, trees, out);
      }
    }
  });
  return leaves;
}

std::vector<std::int32_t> assign_leaves_readably(const Forest& forest, const std::vector<FeatureImage>& features,
                                                 const PatchGrid& patches) {
  std::vector<std::int32_t> leaves;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const PatchView patch = features[patches.level[p]].patch(patches.x[p], patches.y[p], patches.scale[p]);
    for (std::size_t tree = 0; tree < forest.roots.size(); ++tree) {
      leaves.push_back(find_leaf(forest, static_cast<int>(tree), patch));
    }
  }
  return leaves;
}

}  // namespace houghstream
