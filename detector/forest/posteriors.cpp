#include "detector/forest/posteriors.hpp"

#include <hwy/cache_control.h>

#include <algorithm>

namespace houghstream {
namespace {

/// Sums over the trees the largest posterior of the leaf that each patch of a run reached. It bounds the patch's sum
/// for every class from above, even with rounding, since both are summed in the same order.
void sum_max_posteriors(const ForestIndex& index, const RunLeaves& run_leaves, std::vector<float>& sums) {
  const std::vector<LeafSummary>& summaries = index.leaf_summaries();
  sums.assign(run_leaves.count, 0.0F);
  const std::int32_t* leaves = run_leaves.leaves;
  for (std::size_t tree = 0; tree < index.forest().roots.size(); ++tree, leaves += run_leaves.count) {
    for (std::size_t i = 0; i < run_leaves.count; ++i) sums[i] += summaries[leaves[i]].max_posterior;
  }
}

/// Range of the class entries of a leaf; a leaf has few classes even in a large forest.
struct LeafClassRange {
  const LeafClass* begin;
  const LeafClass* end;
};

LeafClassRange classes_of_leaf(const ForestIndex& index, std::int32_t leaf) {
  const LeafSummary* summary = &index.leaf_summaries()[static_cast<std::size_t>(leaf)];
  const LeafClass* classes = index.forest().leaf_classes.data();
  return {classes + summary[0].first_class, classes + summary[1].first_class};
}

/// Sums over the trees of p(class | leaf) for the candidate patches of a run: element [i * classes + class].
void sum_by_class(const ForestIndex& index, const std::vector<std::uint32_t>& candidates, const RunLeaves& run_leaves,
                  std::vector<float>& sums) {
  constexpr std::size_t kAhead = 16;  // patches, so that their cache misses overlap
  const std::size_t classes = index.forest().classes.size();
  sums.assign(candidates.size() * classes, 0.0F);
  const std::int32_t* leaves = run_leaves.leaves;
  for (std::size_t tree = 0; tree < index.forest().roots.size();
       ++tree, leaves += run_leaves.count) {  // stays in the cache
    float* sums_of_patch = sums.data();
    for (std::size_t i = 0; i < candidates.size(); ++i, sums_of_patch += classes) {
      if (i + kAhead < candidates.size()) hwy::Prefetch(classes_of_leaf(index, leaves[candidates[i + kAhead]]).begin);
      const LeafClassRange leaf_classes = classes_of_leaf(index, leaves[candidates[i]]);
      for (const LeafClass* of = leaf_classes.begin; of != leaf_classes.end; ++of)
        sums_of_patch[of->class_index] += of->probability;
    }
  }
}

/// Appends the class's entries in the leaves that the run's patch number `i` reached, tree by tree.
void append_entries(const ForestIndex& index, std::size_t class_index, std::size_t i, const RunLeaves& run_leaves,
                    std::vector<SupportingEntry>& entries) {
  for (std::size_t tree = 0; tree < index.forest().roots.size(); ++tree) {
    const std::int32_t leaf = run_leaves.leaves[tree * run_leaves.count + i];
    const LeafClassRange leaf_classes = classes_of_leaf(index, leaf);
    LeafStart start = index.leaf_starts()[static_cast<std::size_t>(leaf)];
    const LeafClass* of = leaf_classes.begin;
    for (; of != leaf_classes.end && of->class_index != class_index; ++of) start.pass(*of);
    if (of != leaf_classes.end) entries.push_back({start, *of});
  }
}

}  // namespace

void PatchPosteriors::reset(const ForestIndex& index, std::size_t runs, float min_fraction, int threads) {
  index_ = &index;
  min_fraction_ = min_fraction;
  workers_.resize(threads);
  used_ = runs * index.forest().classes.size();
  supporters_.resize(std::max(supporters_.size(), used_));
  for (SupportingPatches& supporters : supporters_) {
    supporters.patches.clear();
    supporters.ends.clear();
    supporters.entries.clear();
  }
}

void PatchPosteriors::note(const RunLeaves& run_leaves) {
  auto& [sums, candidates] = workers_[run_leaves.worker];
  const std::size_t classes = index_->forest().classes.size();
  const auto trees = static_cast<float>(index_->forest().roots.size());
  sum_max_posteriors(*index_, run_leaves, sums);
  candidates.clear();
  for (std::uint32_t i = 0; i < run_leaves.count; ++i) {
    if (sums[i] / trees >= min_fraction_) candidates.push_back(i);
  }
  sum_by_class(*index_, candidates, run_leaves, sums);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (std::size_t c = 0; c < classes; ++c) {
      if (sums[i * classes + c] / trees < min_fraction_) continue;
      SupportingPatches& supporters = supporters_[run_leaves.run * classes + c];
      supporters.patches.push_back(run_leaves.patches[candidates[i]]);
      append_entries(*index_, c, candidates[i], run_leaves, supporters.entries);
      supporters.ends.push_back(static_cast<std::uint32_t>(supporters.entries.size()));
    }
  }
}

void find_posteriors(const PosteriorInput& input, LeafWorkspace& workspace, PatchPosteriors& posteriors) {
  std::vector<PatchRun>& runs = workspace.runs;
  list_runs(input.patches, runs);
  LeafInput leaves{input.index, input.features, input.patches, runs};
  leaves.early_rejection = {input.settings.first_trees, input.settings.min_first_posterior};
  posteriors.reset(input.index, runs.size(), input.settings.min_class_fraction, input.threads);
  find_leaves(leaves, input.threads, workspace, [&](const RunLeaves& run_leaves) { posteriors.note(run_leaves); });
}

}  // namespace houghstream
