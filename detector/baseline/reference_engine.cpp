#include "detector/baseline/reference_engine.hpp"

#include <vector>

#include "detector/baseline/reference_features.hpp"
#include "detector/features/features.hpp"
#include "detector/forest/traversal.hpp"

namespace houghstream::baseline {
namespace {

void compute_whole_features(const FeatureInput& input, int, FeatureMemory&, FeatureImage& image) {
  image = reference_features(input.frame, input.settings);
}

void find_leaves_one_by_one(const LeafInput& input, int threads, LeafMemory&, const LeafVisitor& visit) {
  const Forest& forest = input.index.forest();
  const PatchGrid& patches = input.patches;
  const EarlyEnd& early_end = input.early_end;
  const int trees = static_cast<int>(forest.roots.size());
  parallel_for_workers(threads, static_cast<int>(input.runs.size()), [&](int worker, int r) {
    const PatchRun& run = input.runs[static_cast<std::size_t>(r)];
    std::vector<std::uint32_t> left;
    std::vector<std::vector<std::int32_t>> by_tree(forest.roots.size());
    for (std::size_t p = run.first; p < run.first + run.count; ++p) {
      const PatchView patch = input.features[patches.level[p]].patch(patches.x[p], patches.y[p], patches.scale[p]);
      float certainty = 0.0F;
      for (int tree = 0; early_end.is_used(forest) && tree < early_end.trees; ++tree) {
        certainty += input.index.leaf_heads()[find_leaf(forest, tree, patch)].certainty;
      }
      if (early_end.is_used(forest) && !early_end.goes_on(certainty)) continue;
      left.push_back(static_cast<std::uint32_t>(p));
      for (int tree = 0; tree < trees; ++tree) by_tree[tree].push_back(find_leaf(forest, tree, patch));
    }
    std::vector<std::int32_t> leaves;
    for (const std::vector<std::int32_t>& of_tree : by_tree)
      leaves.insert(leaves.end(), of_tree.begin(), of_tree.end());
    visit({static_cast<std::size_t>(r), left.size(), left.data(), leaves.data(), worker});
  });
}

}  // namespace

const Engine& reference_engine() {
  static constexpr Engine kReference = {compute_whole_features, find_leaves_one_by_one};
  return kReference;
}

}  // namespace houghstream::baseline
