#include "detector/forest/posteriors.hpp"

#include <hwy/cache_control.h>

#include <algorithm>

namespace houghstream {
namespace {

/// Sums over the trees of what the leaves of a run's patches are most certain of: for no class is a patch's sum larger,
/// not even by rounding, as long as it is summed in the same order.
void sum_certainties(const ForestIndex& index, const RunLeaves& seen, std::vector<float>& sums) {
  const std::vector<LeafSummary>& summaries = index.leaf_summaries();
  sums.assign(seen.count, 0.0F);
  const std::int32_t* leaves = seen.leaves;
  for (std::size_t tree = 0; tree < index.forest().roots.size(); ++tree, leaves += seen.count) {
    for (std::size_t i = 0; i < seen.count; ++i) sums[i] += summaries[leaves[i]].max_posterior;
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

/// Sums over the trees of p(class | leaf) for some of the patches of a run: element [i * classes + class].
void sum_by_class(const ForestIndex& index, const std::vector<std::uint32_t>& some, const RunLeaves& seen,
                  std::vector<float>& sums) {
  constexpr std::size_t kAhead = 16;  // patches, so that their cache misses overlap
  const std::size_t classes = index.forest().classes.size();
  sums.assign(some.size() * classes, 0.0F);
  const std::int32_t* leaves = seen.leaves;
  for (std::size_t tree = 0; tree < index.forest().roots.size(); ++tree, leaves += seen.count) {  // stays in the cache
    float* sums_of_patch = sums.data();
    for (std::size_t i = 0; i < some.size(); ++i, sums_of_patch += classes) {
      if (i + kAhead < some.size()) hwy::Prefetch(classes_of_leaf(index, leaves[some[i + kAhead]]).begin);
      const LeafClassRange known = classes_of_leaf(index, leaves[some[i]]);
      for (const LeafClass* of = known.begin; of != known.end; ++of) sums_of_patch[of->class_index] += of->probability;
    }
  }
}

/// Appends the indices, into Forest::leaf_classes, of the class's entries in the leaves that the run's patch number `i`
/// reached, tree by tree.
void append_entries(const ForestIndex& index, std::size_t class_index, std::size_t i, const RunLeaves& seen,
                    std::vector<std::uint32_t>& entries) {
  for (std::size_t tree = 0; tree < index.forest().roots.size(); ++tree) {
    const LeafClassRange known = classes_of_leaf(index, seen.leaves[tree * seen.count + i]);
    const auto is_it = [&](const LeafClass& of) { return of.class_index == class_index; };
    const LeafClass* found = std::find_if(known.begin, known.end, is_it);
    if (found != known.end) entries.push_back(static_cast<std::uint32_t>(found - index.forest().leaf_classes.data()));
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

void PatchPosteriors::note(const RunLeaves& seen) {
  auto& [sums, some] = workers_[seen.worker];
  const std::size_t classes = index_->forest().classes.size();
  const auto trees = static_cast<float>(index_->forest().roots.size());
  sum_certainties(*index_, seen, sums);
  some.clear();
  for (std::uint32_t i = 0; i < seen.count; ++i) {
    if (sums[i] / trees >= min_fraction_) some.push_back(i);
  }
  sum_by_class(*index_, some, seen, sums);
  for (std::size_t i = 0; i < some.size(); ++i) {
    for (std::size_t c = 0; c < classes; ++c) {
      if (sums[i * classes + c] / trees < min_fraction_) continue;
      SupportingPatches& supporters = supporters_[seen.run * classes + c];
      supporters.patches.push_back(seen.patches[some[i]]);
      append_entries(*index_, c, some[i], seen, supporters.entries);
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
  find_leaves(leaves, input.threads, workspace, [&](const RunLeaves& seen) { posteriors.note(seen); });
}

}  // namespace houghstream
