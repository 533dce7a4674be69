#pragma once

#include <cstdint>
#include <vector>

#include "detector/features/feature_image.hpp"
#include "detector/forest/forest_index.hpp"
#include "detector/forest/leaf_settings.hpp"
#include "detector/forest/traversal.hpp"

namespace houghstream {

/// What a leaf that a patch reached knows of a class.
struct SupportingEntry {
  LeafStart start;  ///< start of its votes and views
  LeafClass leaf_class;
};

/// Patches of one run that vote for one class, in the grid's order.
struct SupportingPatches {
  std::vector<std::uint32_t> patches;    ///< indices into the PatchGrid
  std::vector<std::uint32_t> ends;       ///< end of each patch's entries; they begin where those before it end
  std::vector<SupportingEntry> entries;  ///< the class's entries in a patch's leaves, tree by tree
};

/// Patches that vote for each class: those whose posterior p(class | patch), the mean over the trees of p(class |
/// leaf), is large enough (Gall et al. 2011). Most vote for none.
class PatchPosteriors {
 public:
  PatchPosteriors() = default;
  /// Makes posteriors with which a patch votes for a class from a posterior of `min_fraction` on. The index must
  /// outlive this.
  PatchPosteriors(const ForestIndex& index, std::size_t runs, float min_fraction) {
    reset(index, runs, min_fraction, 1);
  }
  /// Resets to the state of a new object, for so many workers, and keeps the memory.
  void reset(const ForestIndex& index, std::size_t runs, float min_fraction, int threads);

  /// Notes which patches of a run vote. Different workers may note different runs at the same time.
  void note(const RunLeaves& run_leaves);

  /// Calls visit(patch, entries, count) for every patch that votes for the class, in the grid's order.
  template <typename Visit>
  void for_each_supporting_patch(int class_index, const Visit& visit) const {
    if (index_ == nullptr) return;
    const std::size_t classes = index_->forest().classes.size();
    for (std::size_t s = static_cast<std::size_t>(class_index); s < used_; s += classes) {
      const SupportingPatches& supporters = supporters_[s];
      std::uint32_t begin = 0;
      for (std::size_t i = 0; i < supporters.patches.size(); ++i) {
        visit(supporters.patches[i], supporters.entries.data() + begin, supporters.ends[i] - begin);
        begin = supporters.ends[i];
      }
    }
  }

 private:
  struct Worker {
    std::vector<float> sums;
    std::vector<std::uint32_t> candidates;
  };

  const ForestIndex* index_ = nullptr;
  float min_fraction_ = 0.0F;
  std::vector<SupportingPatches> supporters_;  // [run * classes + class]; more where another forest had more classes
  std::size_t used_ = 0;                       // number of supporters in use
  PerWorker<Worker> workers_;
};

/// Patches whose posteriors are computed.
struct PosteriorInput {
  const ForestIndex& index;
  const std::vector<FeatureImage>& features;  ///< one image for each level
  const PatchGrid& patches;
  const LeafSettings& settings;
  int threads = 1;
};

/// Finds the leaves of the patches and notes for which classes they vote. `posteriors` is overwritten, and its memory
/// reused.
void find_posteriors(const PosteriorInput& input, LeafWorkspace& workspace, PatchPosteriors& posteriors);

}  // namespace houghstream
