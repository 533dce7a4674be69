#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/features/patch_grid.hpp"
#include "detector/forest/forest_index.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream {

/// Number of trees after which a patch may be rejected, and the condition, see LeafSettings.
struct EarlyRejection {
  int trees = 0;                    ///< 0 = no patch is rejected
  float min_mean_posterior = 0.0F;  ///< mean of LeafSummary::max_posterior that must be reached

  bool is_enabled(const Forest& forest) const { return trees > 0 && trees < static_cast<int>(forest.roots.size()); }
  /// Returns whether the patch continues. `sum` is that of LeafSummary::max_posterior, added in the trees' order.
  bool is_accepted(float sum) const { return sum >= min_mean_posterior * static_cast<float>(trees); }
};

/// Patches, and the trees whose leaves are searched.
struct LeafInput {
  const ForestIndex& index;
  const std::vector<FeatureImage>& features;  ///< one image for each level
  const PatchGrid& patches;
  const std::vector<PatchRun>& runs;
  EarlyRejection early_rejection = {};
};

/// The leaves of those patches of a run that were not rejected.
struct RunLeaves {
  std::size_t run = 0;
  std::size_t count = 0;                   ///< patches
  const std::uint32_t* patches = nullptr;  ///< indices into the PatchGrid, in its order
  const std::int32_t* leaves = nullptr;    ///< tree by tree: leaves[tree * count + i] is that of patches[i]
  int worker = 0;                          ///< worker that visits the run, see parallel_for_workers
};

using LeafVisitor = std::function<void(const RunLeaves&)>;

/// Workspace of find_leaves(), reused from frame to frame.
struct LeafWorkspace {
  struct Worker {
    std::vector<std::int32_t> leaves;    ///< leaves tree by tree, of the accepted patches
    std::vector<std::uint32_t> patches;  ///< indices of the accepted patches into the grid
    std::vector<float> sums;             ///< sums of LeafSummary::max_posterior
    std::vector<std::int16_t> x;         ///< coordinates of the accepted patches
    std::vector<std::int16_t> y;
    std::vector<std::int32_t> scale;
  };
  std::vector<PatchRun> runs;  ///< see find_posteriors
  PerWorker<Worker> workers;
};

/// Finds the leaf of every patch in every tree, except of rejected patches. Many patches are traversed together, and
/// runs are visited concurrently; the leaves are those of find_leaf().
void find_leaves(const LeafInput& input, int threads, LeafWorkspace& workspace, const LeafVisitor& visit);

}  // namespace houghstream
