#include "detector/beliefs.hpp"

#include <algorithm>

namespace houghstream {
namespace {

/// Per leaf, the largest p(class | leaf) of all classes.
std::vector<float> most_certain(const Forest& forest) {
  std::vector<float> most(forest.leaves.size() - 1, 0.0F);
  for (std::size_t leaf = 0; leaf < most.size(); ++leaf) {
    for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) {
      most[leaf] = std::max(most[leaf], forest.leaf_classes[e].probability);
    }
  }
  return most;
}

/// Sums over the trees of what the leaves of a run's patches are most certain of: for no class is a patch's sum larger,
/// not even by rounding, as long as it is summed in the same order.
void sum_largest(const std::vector<float>& most, std::size_t trees, std::size_t patches, const std::int32_t* leaves,
                 std::vector<float>& sums) {
  sums.assign(patches, 0.0F);
  for (std::size_t tree = 0; tree < trees; ++tree, leaves += patches) {
    for (std::size_t p = 0; p < patches; ++p) sums[p] += most[static_cast<std::size_t>(leaves[p])];
  }
}

/// Sums over the trees of p(class | leaf) for some of the patches of a run: element [i * classes + class].
void sum_by_class(const Forest& forest, const std::vector<std::uint32_t>& some, std::size_t patches,
                  const std::int32_t* leaves, std::vector<float>& sums) {
  const std::size_t classes = forest.classes.size();
  sums.assign(some.size() * classes, 0.0F);
  for (std::size_t tree = 0; tree < forest.roots.size(); ++tree, leaves += patches) {  // stays in the cache
    for (std::size_t i = 0; i < some.size(); ++i) {
      const auto leaf = static_cast<std::size_t>(leaves[some[i]]);
      for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) {
        const LeafClass& entry = forest.leaf_classes[e];
        sums[i * classes + entry.class_index] += entry.probability;
      }
    }
  }
}

/// What the leaves of patch `p` of a run know of a class.
void append_entries(const Forest& forest, std::size_t class_index, std::size_t p, std::size_t patches,
                    const std::int32_t* leaves, std::vector<std::uint32_t>& entries) {
  for (std::size_t tree = 0; tree < forest.roots.size(); ++tree) {
    const auto leaf = static_cast<std::size_t>(leaves[tree * patches + p]);
    for (std::uint32_t e = forest.leaves[leaf]; e < forest.leaves[leaf + 1]; ++e) {
      if (forest.leaf_classes[e].class_index == class_index) entries.push_back(e);
    }
  }
}

}  // namespace

PatchBeliefs::PatchBeliefs(const Forest& forest, std::size_t runs, float least_share)
    : forest_(&forest),
      least_share_(least_share),
      most_certain_(most_certain(forest)),
      believers_(runs * forest.classes.size()) {}

void PatchBeliefs::note(std::size_t run, const PatchRun& patches, const std::int32_t* leaves) {
  static thread_local std::vector<float> sums;  // both kept from run to run
  static thread_local std::vector<std::uint32_t> some;
  const std::size_t classes = forest_->classes.size();
  const auto trees = static_cast<float>(forest_->roots.size());
  sum_largest(most_certain_, forest_->roots.size(), patches.count, leaves, sums);
  some.clear();
  for (std::uint32_t p = 0; p < patches.count; ++p) {
    if (sums[p] / trees >= least_share_) some.push_back(p);
  }
  sum_by_class(*forest_, some, patches.count, leaves, sums);
  for (std::size_t i = 0; i < some.size(); ++i) {
    for (std::size_t c = 0; c < classes; ++c) {
      if (sums[i * classes + c] / trees < least_share_) continue;
      Believers& believers = believers_[run * classes + c];
      believers.patches.push_back(static_cast<std::uint32_t>(patches.first) + some[i]);
      append_entries(*forest_, c, some[i], patches.count, leaves, believers.entries);
      believers.ends.push_back(static_cast<std::uint32_t>(believers.entries.size()));
    }
  }
}

PatchBeliefs classify(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                      const DetectionSettings& settings) {
  const std::vector<PatchRun> runs = patch_runs(patches);
  PatchBeliefs beliefs(forest, runs.size(), settings.min_class_share);
  const auto note = [&](std::size_t run, const std::int32_t* leaves) { beliefs.note(run, runs[run], leaves); };
  if (settings.readable) {
    find_leaves_readably(forest, features, patches, runs, note);
  } else {
    find_leaves(forest, features, patches, runs, settings.threads, note);
  }
  return beliefs;
}

}  // namespace houghstream
