#include "detector/traversal.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/parallel.hpp"

namespace houghstream {
namespace {

constexpr int kLanes = 8;  // patches in flight

/// Walks up to kLanes patches down one tree in step. Lanes that have arrived wait.
void walk_lanes(const Forest& forest, std::int32_t root, const FeatureImage& features, const PatchGrid& patches,
                std::size_t first, int lanes, std::array<std::int32_t, kLanes>& at) {
  const int row_stride = features.row_stride();
  std::array<const std::uint8_t*, kLanes> centres{};
  std::array<std::int32_t, kLanes> scales{};
  for (int l = 0; l < lanes; ++l) {
    const std::size_t p = first + static_cast<std::size_t>(l);
    centres[static_cast<std::size_t>(l)] = features.at(patches.x[p], patches.y[p]);
    scales[static_cast<std::size_t>(l)] = patches.scale[p];
    at[static_cast<std::size_t>(l)] = root;
  }
  const TreeNode* nodes = forest.nodes.data();
  bool walking = root >= 0;
  while (walking) {
    walking = false;
    for (std::size_t l = 0; l < static_cast<std::size_t>(lanes); ++l) {
      if (at[l] < 0) continue;
      const TreeNode& node = nodes[at[l]];
      const bool right = test_value(node.test, centres[l], scales[l], row_stride) >= node.test.threshold;
      at[l] = right ? node.right : node.left;
      walking = walking || at[l] >= 0;
    }
  }
}

}  // namespace

PatchGrid make_patch_grid(const WorkingFrame& frame, const PatchSettings& patch, int stride) {
  PatchGrid grid;
  for (int y = stride / 2; y < frame.filled_depth.rows; y += stride) {
    const auto* depth = frame.filled_depth.ptr<float>(y);
    for (int x = stride / 2; x < frame.filled_depth.cols; x += stride) {
      const float z = depth[x];
      if (!std::isfinite(z) || z <= 0.0F) continue;
      grid.x.push_back(static_cast<std::int16_t>(x));
      grid.y.push_back(static_cast<std::int16_t>(y));
      grid.scale.push_back(patch_scale(patch, frame.camera.fx, z));
      grid.point_camera.emplace_back(frame.camera.backproject(x, y, z).cast<float>());
    }
  }
  return grid;
}

std::vector<std::int32_t> assign_leaves(const Forest& forest, const FeatureImage& features, const PatchGrid& patches,
                                        int threads) {
  const std::size_t trees = forest.roots.size();
  std::vector<std::int32_t> leaves(patches.size() * trees);
  constexpr std::size_t kBand = 1024;  // patches: their pixels stay in the cache from tree to tree
  const int bands = static_cast<int>((patches.size() + kBand - 1) / kBand);
  parallel_for(threads, bands, [&](int band) {
    const std::size_t begin = static_cast<std::size_t>(band) * kBand;
    const std::size_t end = std::min(begin + kBand, patches.size());
    std::array<std::int32_t, kLanes> at{};
    for (std::size_t tree = 0; tree < trees; ++tree) {
      for (std::size_t first = begin; first < end; first += kLanes) {
        const int lanes = static_cast<int>(std::min<std::size_t>(kLanes, end - first));
        walk_lanes(forest, forest.roots[tree], features, patches, first, lanes, at);
        for (int l = 0; l < lanes; ++l) {
          leaves[(first + static_cast<std::size_t>(l)) * trees + tree] = -1 - at[static_cast<std::size_t>(l)];
        }
      }
    }
  });
  return leaves;
}

}  // namespace houghstream
