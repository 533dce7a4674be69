#include "detector/baseline/reference_stages.hpp"

#include <vector>

#include "detector/baseline/reference_features.hpp"
#include "detector/baseline/surface_planes.hpp"

namespace houghstream::baseline {

void reference_leaves(const LeafInput& input, int threads, const LeafVisitor& visit) {
  const Forest& forest = input.index.forest();
  const PatchGrid& patches = input.patches;
  const EarlyRejection& early_rejection = input.early_rejection;
  const int trees = static_cast<int>(forest.roots.size());
  parallel_for_workers(threads, static_cast<int>(input.runs.size()), [&](int worker, int r) {
    const PatchRun& run = input.runs[static_cast<std::size_t>(r)];
    std::vector<std::uint32_t> left;
    std::vector<std::vector<std::int32_t>> by_tree(forest.roots.size());
    for (std::size_t p = run.first; p < run.first + run.count; ++p) {
      const PatchView patch = input.features[patches.level[p]].patch(patches.x[p], patches.y[p], patches.scale[p]);
      float certainty = 0.0F;
      for (int tree = 0; early_rejection.is_enabled(forest) && tree < early_rejection.trees; ++tree) {
        certainty += input.index.leaf_summaries()[find_leaf(forest, tree, patch)].max_posterior;
      }
      if (early_rejection.is_enabled(forest) && !early_rejection.is_accepted(certainty)) continue;
      left.push_back(static_cast<std::uint32_t>(p));
      for (int tree = 0; tree < trees; ++tree) by_tree[tree].push_back(find_leaf(forest, tree, patch));
    }
    std::vector<std::int32_t> leaves;
    for (const std::vector<std::int32_t>& of_tree : by_tree)
      leaves.insert(leaves.end(), of_tree.begin(), of_tree.end());
    visit({static_cast<std::size_t>(r), left.size(), left.data(), leaves.data(), worker});
  });
}

void compute_features_by(Way way, const FeatureInput& input, int threads, FeatureWorkspace& workspace,
                         FeatureImage& image) {
  if (way == Way::kReference) {
    image = reference_features(input.frame, input.settings);
    return;
  }
  const ExtraPlanes extra = extra_planes(input.frame, input.settings, threads);
  compute_features({input.frame, input.settings, input.tiles, &extra}, threads, workspace, image);
}

void compute_features_by(Way way, const SearchContext& search, DetectorWorkspace& workspace) {
  const std::vector<WorkingFrame>& frames = workspace.images.frames;
  place_patches(workspace.images, {search.forest().patch, search.settings.spacing}, workspace.patches);
  workspace.features.resize(frames.size());
  for (std::size_t level = 0; level < frames.size(); ++level) {
    compute_features_by(way, {frames[level], search.forest().features, workspace.patches.tiles[level]},
                        search.settings.threads, workspace.feature_workspace, workspace.features[level]);
  }
}

void find_posteriors_by(Way way, const PosteriorInput& input, LeafWorkspace& workspace, PatchPosteriors& posteriors) {
  if (way == Way::kFast) return find_posteriors(input, workspace, posteriors);
  list_runs(input.patches, workspace.runs);
  LeafInput leaves{input.index, input.features, input.patches, workspace.runs};
  leaves.early_rejection = {input.settings.first_trees, input.settings.min_first_posterior};
  posteriors.reset(input.index, workspace.runs.size(), input.settings.min_class_fraction, input.threads);
  reference_leaves(leaves, input.threads, [&](const RunLeaves& seen) { posteriors.note(seen); });
}

}  // namespace houghstream::baseline
