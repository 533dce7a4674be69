#include "detector/forest/traversal.hpp"

#include <numeric>

#include "detector/forest/batched_traversal.hpp"

namespace houghstream {
namespace {

/// Finds the leaves of patches of one level in some of the trees.
void traverse_trees(const ForestIndex& index, const PatchBatch& batch, TreeRange trees, std::int32_t* leaves) {
  if (traverse_batched(index.packed(), trees, batch, leaves)) return;
  for (std::size_t tree = trees.first; tree < trees.last; ++tree, leaves += batch.count) {
    for (int p = 0; p < batch.count; ++p) {
      const PatchView patch = batch.image->patch(batch.x[p], batch.y[p], batch.scale[p]);
      leaves[p] = find_leaf(index.forest(), static_cast<int>(tree), patch);
    }
  }
}

/// Rejects patches, and closes their gaps in the leaves of the first trees.
void reject_patches(const ForestIndex& index, const EarlyRejection& early_rejection, const PatchRun& run,
                    LeafWorkspace::Worker& workspace) {
  workspace.sums.assign(run.count, 0.0F);
  const std::int32_t* leaves = workspace.leaves.data();
  for (int tree = 0; tree < early_rejection.trees; ++tree, leaves += run.count) {
    for (std::size_t i = 0; i < run.count; ++i) workspace.sums[i] += index.leaf_summaries()[leaves[i]].max_posterior;
  }
  workspace.patches.clear();
  for (std::size_t i = 0; i < run.count; ++i) {
    if (early_rejection.is_accepted(workspace.sums[i]))
      workspace.patches.push_back(static_cast<std::uint32_t>(run.first + i));
  }
  std::int32_t* to = workspace.leaves.data();
  for (int tree = 0; tree < early_rejection.trees; ++tree) {
    const std::int32_t* from = workspace.leaves.data() + static_cast<std::size_t>(tree) * run.count;
    for (const std::uint32_t p : workspace.patches) *to++ = from[p - run.first];
  }
}

/// Returns the accepted patches, side by side.
PatchBatch gather_accepted(const FeatureImage& image, const PatchGrid& patches, LeafWorkspace::Worker& workspace) {
  workspace.x.clear();
  workspace.y.clear();
  workspace.scale.clear();
  for (const std::uint32_t p : workspace.patches) {
    workspace.x.push_back(patches.x[p]);
    workspace.y.push_back(patches.y[p]);
    workspace.scale.push_back(patches.scale[p]);
  }
  PatchBatch accepted;
  accepted.image = &image;
  accepted.x = workspace.x.data();
  accepted.y = workspace.y.data();
  accepted.scale = workspace.scale.data();
  accepted.count = static_cast<int>(workspace.x.size());
  return accepted;
}

/// Finds the leaves of one run.
void traverse_run(const LeafInput& input, const PatchRun& run, LeafWorkspace::Worker& workspace) {
  const ForestIndex& index = input.index;
  const PatchGrid& patches = input.patches;
  const FeatureImage& image = input.features[patches.level[run.first]];
  const std::size_t trees = index.forest().roots.size();
  const bool can_reject = input.early_rejection.is_enabled(index.forest());
  const std::size_t first = can_reject ? static_cast<std::size_t>(input.early_rejection.trees) : trees;
  workspace.leaves.resize(run.count * trees);
  PatchBatch all;
  all.image = &image;
  all.x = patches.x.data() + run.first;
  all.y = patches.y.data() + run.first;
  all.scale = patches.scale.data() + run.first;
  all.count = static_cast<int>(run.count);
  traverse_trees(index, all, {0, first}, workspace.leaves.data());
  if (!can_reject) {
    workspace.patches.resize(run.count);
    std::iota(workspace.patches.begin(), workspace.patches.end(), static_cast<std::uint32_t>(run.first));
    return;
  }
  reject_patches(index, input.early_rejection, run, workspace);
  const PatchBatch accepted = gather_accepted(image, patches, workspace);
  traverse_trees(index, accepted, {first, trees}, workspace.leaves.data() + first * workspace.patches.size());
}

}  // namespace

void find_leaves(const LeafInput& input, int threads, LeafWorkspace& workspaces, const LeafVisitor& visit) {
  workspaces.workers.resize(threads);
  parallel_for_workers(threads, static_cast<int>(input.runs.size()), [&](int worker, int r) {
    LeafWorkspace::Worker& workspace = workspaces.workers[worker];
    const auto run = static_cast<std::size_t>(r);
    traverse_run(input, input.runs[run], workspace);
    visit({run, workspace.patches.size(), workspace.patches.data(), workspace.leaves.data(), worker});
  });
}

}  // namespace houghstream
