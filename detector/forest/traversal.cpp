#include "detector/forest/traversal.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "detector/forest/patch_square.hpp"
#include "detector/forest/square_forest.hpp"
#include "detector/forest/square_planes.hpp"
#include "detector/forest/square_walk.hpp"
#include "detector/forest/wide_walk.hpp"
#include "pipeline/base/parallel.hpp"

namespace houghstream {
namespace {

/// What a thread needs for a run, kept from run to run.
struct Scratch {
  std::vector<std::int32_t> leaves;    // tree by tree, of the patches that are left
  std::vector<std::uint32_t> patches;  // those left, into the grid
  std::vector<float> sums;             // of the leaves' certainties
  std::vector<std::int16_t> x;         // of those left
  std::vector<std::int16_t> y;
  std::vector<std::int32_t> scale;
  PatchSquare square;
  std::vector<std::uint8_t> planes;  // of the square
};

/// Leaves of patches of one level in some of the trees.
void walk_trees(const Forest& forest, const WalkingPatches& walking, TreeRange trees, std::int32_t* leaves) {
  if (walk_wide(forest, trees, walking, leaves)) return;
  for (std::size_t tree = trees.first; tree < trees.last; ++tree, leaves += walking.count) {
    for (int p = 0; p < walking.count; ++p) {
      const PatchView patch = walking.image->patch(walking.x[p], walking.y[p], walking.scale[p]);
      leaves[p] = find_leaf(forest, static_cast<int>(tree), patch);
    }
  }
}

/// What squares of patches need.
struct ForSquares {
  SquareForest forest;
  ScaleClasses classes;
};

/// Leaves of a square in the first trees.
void walk_square_run(const ForSquares& ready, const FeatureImage& image, const PatchGrid& patches, const PatchRun& run,
                     std::size_t trees, Scratch& scratch) {
  group_patches(patches, run, ready.classes, ready.forest.radius, image.pixel_stride(), scratch.square);
  copy_planes(image, scratch.square, scratch.planes);
  walk_square(ready.forest, static_cast<int>(trees), scratch.square, scratch.planes, scratch.leaves.data());
}

/// Gives patches up and closes the gaps that they leave in the leaves of the first `walked` trees.
void give_up(const Forest& forest, const EarlyEnd& early_end, const PatchRun& run, std::size_t walked,
             Scratch& scratch) {
  scratch.sums.assign(run.count, 0.0F);
  const std::int32_t* leaves = scratch.leaves.data();
  for (int tree = 0; tree < early_end.trees; ++tree, leaves += run.count) {
    for (std::size_t i = 0; i < run.count; ++i) scratch.sums[i] += forest.leaf_heads[leaves[i]].certainty;
  }
  scratch.patches.clear();
  for (std::size_t i = 0; i < run.count; ++i) {
    if (early_end.goes_on(scratch.sums[i])) scratch.patches.push_back(static_cast<std::uint32_t>(run.first + i));
  }
  std::int32_t* to = scratch.leaves.data();
  for (std::size_t tree = 0; tree < walked; ++tree) {
    const std::int32_t* from = scratch.leaves.data() + tree * run.count;
    for (const std::uint32_t p : scratch.patches) *to++ = from[p - run.first];
  }
}

/// The patches that are left, side by side.
WalkingPatches gather_left(const FeatureImage& image, const PatchGrid& patches, Scratch& scratch) {
  scratch.x.clear();
  scratch.y.clear();
  scratch.scale.clear();
  for (const std::uint32_t p : scratch.patches) {
    scratch.x.push_back(patches.x[p]);
    scratch.y.push_back(patches.y[p]);
    scratch.scale.push_back(patches.scale[p]);
  }
  return {&image, scratch.x.data(), scratch.y.data(), scratch.scale.data(), static_cast<int>(scratch.x.size())};
}

/// Leaves of one run; `for_squares` where it is a square.
void walk_run(const Forest& forest, const ForSquares* for_squares, const FeatureImage& image, const PatchGrid& patches,
              const PatchRun& run, const EarlyEnd& early_end, Scratch& scratch) {
  const std::size_t trees = forest.roots.size();
  const bool may_end = early_end.is_used(forest);
  const std::size_t first = may_end ? static_cast<std::size_t>(early_end.trees) : trees;
  scratch.leaves.resize(run.count * trees);
  if (for_squares != nullptr) {
    walk_square_run(*for_squares, image, patches, run, first, scratch);
  } else {
    const WalkingPatches all{&image, patches.x.data() + run.first, patches.y.data() + run.first,
                             patches.scale.data() + run.first, static_cast<int>(run.count)};
    walk_trees(forest, all, {0, first}, scratch.leaves.data());
  }
  if (!may_end) {
    scratch.patches.resize(run.count);
    std::iota(scratch.patches.begin(), scratch.patches.end(), static_cast<std::uint32_t>(run.first));
    return;
  }
  give_up(forest, early_end, run, first, scratch);
  const WalkingPatches left = gather_left(image, patches, scratch);
  walk_trees(forest, left, {first, trees}, scratch.leaves.data() + first * scratch.patches.size());
}

}  // namespace

void find_leaves(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                 const std::vector<PatchRun>& runs, const EarlyEnd& early_end, int threads, const LeafVisitor& visit) {
  std::optional<ForSquares> for_squares;
  if (!patches.squares.empty()) {
    const std::int32_t largest = *std::max_element(patches.scale.begin(), patches.scale.end());
    for_squares = ForSquares{SquareForest(forest), ScaleClasses(forest.patch.radius, largest)};
  }
  parallel_for(threads, static_cast<int>(runs.size()), [&](int r) {
    static thread_local Scratch scratch;
    const PatchRun& run = runs[static_cast<std::size_t>(r)];
    walk_run(forest, for_squares ? &*for_squares : nullptr, features[patches.level[run.first]], patches, run, early_end,
             scratch);
    visit({static_cast<std::size_t>(r), scratch.patches.size(), scratch.patches.data(), scratch.leaves.data()});
  });
}

void find_leaves_readably(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
                          const std::vector<PatchRun>& runs, const EarlyEnd& early_end, int threads,
                          const LeafVisitor& visit) {
  const int trees = static_cast<int>(forest.roots.size());
  parallel_for(threads, static_cast<int>(runs.size()), [&](int r) {
    const PatchRun& run = runs[static_cast<std::size_t>(r)];
    std::vector<std::uint32_t> left;
    std::vector<std::vector<std::int32_t>> by_tree(forest.roots.size());
    for (std::size_t p = run.first; p < run.first + run.count; ++p) {
      const PatchView patch = features[patches.level[p]].patch(patches.x[p], patches.y[p], patches.scale[p]);
      float certainty = 0.0F;
      for (int tree = 0; early_end.is_used(forest) && tree < early_end.trees; ++tree) {
        certainty += forest.leaf_heads[find_leaf(forest, tree, patch)].certainty;
      }
      if (early_end.is_used(forest) && !early_end.goes_on(certainty)) continue;
      left.push_back(static_cast<std::uint32_t>(p));
      for (int tree = 0; tree < trees; ++tree) by_tree[tree].push_back(find_leaf(forest, tree, patch));
    }
    std::vector<std::int32_t> leaves;
    for (const std::vector<std::int32_t>& of_tree : by_tree)
      leaves.insert(leaves.end(), of_tree.begin(), of_tree.end());
    visit({static_cast<std::size_t>(r), left.size(), left.data(), leaves.data()});
  });
}

}  // namespace houghstream
