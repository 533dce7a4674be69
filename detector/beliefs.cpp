#include "detector/beliefs.hpp"

#include <hwy/cache_control.h>

namespace houghstream {
namespace {

/// Sums over the trees of what the leaves of a run's patches are most certain of: for no class is a patch's sum larger,
/// not even by rounding, as long as it is summed in the same order.
void sum_certainties(const Forest& forest, const RunLeaves& seen, std::vector<float>& sums) {
  sums.assign(seen.count, 0.0F);
  const std::int32_t* leaves = seen.leaves;
  for (std::size_t tree = 0; tree < forest.roots.size(); ++tree, leaves += seen.count) {
    for (std::size_t i = 0; i < seen.count; ++i) sums[i] += forest.leaf_certainty[leaves[i]];
  }
}

/// Sums over the trees of p(class | leaf) for some of the patches of a run: element [i * classes + class].
void sum_by_class(const Forest& forest, const std::vector<std::uint32_t>& some, const RunLeaves& seen,
                  std::vector<float>& sums) {
  constexpr std::size_t kAhead = 16;  // patches, so that their cache misses overlap
  const std::size_t classes = forest.classes.size();
  sums.assign(some.size() * classes, 0.0F);
  const std::int32_t* leaves = seen.leaves;
  for (std::size_t tree = 0; tree < forest.roots.size(); ++tree, leaves += seen.count) {  // stays in the cache
    const auto shares_of = [&](std::size_t i) {
      return forest.leaf_shares.data() + static_cast<std::size_t>(leaves[some[i]]) * classes;
    };
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (i + kAhead < some.size()) hwy::Prefetch(shares_of(i + kAhead));
      const LeafShare* shares = shares_of(i);
      for (std::size_t c = 0; c < classes; ++c) sums[i * classes + c] += shares[c].probability;
    }
  }
}

/// What the leaves of a run's patch number `i` know of a class.
void append_entries(const Forest& forest, std::size_t class_index, std::size_t i, const RunLeaves& seen,
                    std::vector<std::uint32_t>& entries) {
  const std::size_t classes = forest.classes.size();
  std::size_t count = entries.size();
  entries.resize(count + forest.roots.size());
  for (std::size_t tree = 0; tree < forest.roots.size(); ++tree) {  // without a branch that nobody can predict
    const auto leaf = static_cast<std::size_t>(seen.leaves[tree * seen.count + i]);
    const std::uint32_t entry = forest.leaf_shares[leaf * classes + class_index].entry;
    entries[count] = entry;
    count += entry != LeafShare::kNothing ? 1 : 0;
  }
  entries.resize(count);
}

}  // namespace

PatchBeliefs::PatchBeliefs(const Forest& forest, std::size_t runs, float least_share) {
  reset(forest, runs, least_share);
}

void PatchBeliefs::reset(const Forest& forest, std::size_t runs, float least_share) {
  forest_ = &forest;
  least_share_ = least_share;
  believers_.resize(runs * forest.classes.size());
  for (Believers& believers : believers_) {
    believers.patches.clear();
    believers.ends.clear();
    believers.entries.clear();
  }
}

void PatchBeliefs::note(const RunLeaves& seen) {
  static thread_local std::vector<float> sums;  // both kept from run to run
  static thread_local std::vector<std::uint32_t> some;
  const std::size_t classes = forest_->classes.size();
  const auto trees = static_cast<float>(forest_->roots.size());
  sum_certainties(*forest_, seen, sums);
  some.clear();
  for (std::uint32_t i = 0; i < seen.count; ++i) {
    if (sums[i] / trees >= least_share_) some.push_back(i);
  }
  sum_by_class(*forest_, some, seen, sums);
  for (std::size_t i = 0; i < some.size(); ++i) {
    for (std::size_t c = 0; c < classes; ++c) {
      if (sums[i * classes + c] / trees < least_share_) continue;
      Believers& believers = believers_[seen.run * classes + c];
      believers.patches.push_back(seen.patches[some[i]]);
      append_entries(*forest_, c, some[i], seen, believers.entries);
      believers.ends.push_back(static_cast<std::uint32_t>(believers.entries.size()));
    }
  }
}

void classify(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
              const DetectionSettings& settings, PatchBeliefs& beliefs) {
  const std::vector<PatchRun> runs = patch_runs(patches);
  const EarlyEnd early_end{settings.first_trees, settings.min_first_share};
  beliefs.reset(forest, runs.size(), settings.min_class_share);
  const auto note = [&](const RunLeaves& seen) { beliefs.note(seen); };
  if (settings.readable) {
    find_leaves_readably(forest, features, patches, runs, early_end, settings.threads, note);
  } else {
    find_leaves(forest, features, patches, runs, early_end, settings.threads, note);
  }
}

}  // namespace houghstream
