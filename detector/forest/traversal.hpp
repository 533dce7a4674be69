#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/forest/forest.hpp"
#include "detector/forest/patch_grid.hpp"

namespace houghstream {

/// After how many trees a patch may be given up, and when, see DetectionSettings.
struct EarlyEnd {
  int trees = 0;       ///< 0 = no patch is given up
  float share = 0.0F;  ///< mean of LeafHead::certainty that must be reached

  bool is_used(const Forest& forest) const { return trees > 0 && trees < static_cast<int>(forest.roots.size()); }
  /// `sum`: of the certainties, added in the trees' order.
  bool goes_on(float sum) const { return sum >= share * static_cast<float>(trees); }
};

/// The leaves of those patches of a run that were not given up.
struct RunLeaves {
  std::size_t run = 0;
  std::size_t count = 0;                   ///< patches
  const std::uint32_t* patches = nullptr;  ///< into the PatchGrid, in its order
  const std::int32_t* leaves = nullptr;    ///< tree by tree: leaves[tree * count + i] is that of patches[i]
};

using LeafVisitor = std::function<void(const RunLeaves&)>;

/// Leaf of every patch in every tree, but for patches that are given up; `features` holds one image per level. Patches
/// are walked many at once, and runs are visited at the same time; the leaves are those of find_leaf.
void find_leaves(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                 const std::vector<PatchRun>& runs, const EarlyEnd& early_end, int threads, const LeafVisitor& visit);

/// The same leaves, found one after another by find_leaf; with more than one thread, runs are visited at the same time.
void find_leaves_readably(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                          const std::vector<PatchRun>& runs, const EarlyEnd& early_end, int threads,
                          const LeafVisitor& visit);

}  // namespace houghstream
