#include "detector/forest/traversal.hpp"

#include <numeric>

#include "detector/forest/batched_traversal.hpp"

namespace houghstream {
namespace {

/// Leaves of patches of one level in some of the trees.
void walk_trees(const ForestIndex& index, const PatchBatch& walking, TreeRange trees, std::int32_t* leaves) {
  if (traverse_batched(index.packed(), trees, walking, leaves)) return;
  for (std::size_t tree = trees.first; tree < trees.last; ++tree, leaves += walking.count) {
    for (int p = 0; p < walking.count; ++p) {
      const PatchView patch = walking.image->patch(walking.x[p], walking.y[p], walking.scale[p]);
      leaves[p] = find_leaf(index.forest(), static_cast<int>(tree), patch);
    }
  }
}

/// Gives patches up and closes the gaps that they leave in the leaves of the first trees.
void give_up(const ForestIndex& index, const EarlyRejection& early_end, const PatchRun& run, LeafMemory::Worker& own) {
  own.sums.assign(run.count, 0.0F);
  const std::int32_t* leaves = own.leaves.data();
  for (int tree = 0; tree < early_end.trees; ++tree, leaves += run.count) {
    for (std::size_t i = 0; i < run.count; ++i) own.sums[i] += index.leaf_summaries()[leaves[i]].certainty;
  }
  own.patches.clear();
  for (std::size_t i = 0; i < run.count; ++i) {
    if (early_end.goes_on(own.sums[i])) own.patches.push_back(static_cast<std::uint32_t>(run.first + i));
  }
  std::int32_t* to = own.leaves.data();
  for (int tree = 0; tree < early_end.trees; ++tree) {
    const std::int32_t* from = own.leaves.data() + static_cast<std::size_t>(tree) * run.count;
    for (const std::uint32_t p : own.patches) *to++ = from[p - run.first];
  }
}

/// The patches that are left, side by side.
PatchBatch gather_left(const FeatureImage& image, const PatchGrid& patches, LeafMemory::Worker& own) {
  own.x.clear();
  own.y.clear();
  own.scale.clear();
  for (const std::uint32_t p : own.patches) {
    own.x.push_back(patches.x[p]);
    own.y.push_back(patches.y[p]);
    own.scale.push_back(patches.scale[p]);
  }
  PatchBatch left;
  left.image = &image;
  left.x = own.x.data();
  left.y = own.y.data();
  left.scale = own.scale.data();
  left.count = static_cast<int>(own.x.size());
  return left;
}

/// Leaves of one run.
void walk_run(const LeafInput& input, const PatchRun& run, LeafMemory::Worker& own) {
  const ForestIndex& index = input.index;
  const PatchGrid& patches = input.patches;
  const FeatureImage& image = input.features[patches.level[run.first]];
  const std::size_t trees = index.forest().roots.size();
  const bool may_end = input.early_end.is_enabled(index.forest());
  const std::size_t first = may_end ? static_cast<std::size_t>(input.early_end.trees) : trees;
  own.leaves.resize(run.count * trees);
  PatchBatch all;
  all.image = &image;
  all.x = patches.x.data() + run.first;
  all.y = patches.y.data() + run.first;
  all.scale = patches.scale.data() + run.first;
  all.count = static_cast<int>(run.count);
  walk_trees(index, all, {0, first}, own.leaves.data());
  if (!may_end) {
    own.patches.resize(run.count);
    std::iota(own.patches.begin(), own.patches.end(), static_cast<std::uint32_t>(run.first));
    return;
  }
  give_up(index, input.early_end, run, own);
  const PatchBatch left = gather_left(image, patches, own);
  walk_trees(index, left, {first, trees}, own.leaves.data() + first * own.patches.size());
}

}  // namespace

void find_leaves(const LeafInput& input, int threads, LeafMemory& memory, const LeafVisitor& visit) {
  memory.workers.make_room(threads);
  parallel_for_workers(threads, static_cast<int>(input.runs.size()), [&](int worker, int r) {
    LeafMemory::Worker& own = memory.workers[worker];
    const auto run = static_cast<std::size_t>(r);
    walk_run(input, input.runs[run], own);
    visit({run, own.patches.size(), own.patches.data(), own.leaves.data(), worker});
  });
}

}  // namespace houghstream
