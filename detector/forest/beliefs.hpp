#pragma once

#include <cstdint>
#include <vector>

#include "detector/detector_settings.hpp"
#include "detector/features/feature_image.hpp"
#include "detector/forest/forest.hpp"
#include "detector/forest/traversal.hpp"

namespace houghstream {

/// Patches of one run that believe in one class, in the grid's order.
struct Believers {
  std::vector<std::uint32_t> patches;  ///< into the PatchGrid
  std::vector<std::uint32_t> ends;     ///< for each, where its entries end; they begin where those before it end
  std::vector<std::uint32_t> entries;  ///< into Forest::leaf_classes: what its leaves know of the class, tree by tree
};

/// Who believes in which class. Most patches believe in none: voting does not see them.
class PatchBeliefs {
 public:
  PatchBeliefs() = default;
  /// A patch believes in a class from a share of `least_share` on: p(class | patch), the mean over the trees. The
  /// forest must outlive the beliefs.
  PatchBeliefs(const Forest& forest, std::size_t runs, float least_share);
  /// As if made anew, but the memory is used again.
  void reset(const Forest& forest, std::size_t runs, float least_share);

  /// Notes who believes among the patches of a run. Different runs may be noted at the same time.
  void note(const RunLeaves& seen);

  /// Calls visit(patch, entries, count) for every patch that believes in the class, in the grid's order.
  template <typename Visit>
  void for_believers(int class_index, const Visit& visit) const {
    if (forest_ == nullptr) return;
    const std::size_t classes = forest_->classes.size();
    for (std::size_t b = static_cast<std::size_t>(class_index); b < believers_.size(); b += classes) {
      const Believers& believers = believers_[b];
      std::uint32_t begin = 0;
      for (std::size_t i = 0; i < believers.patches.size(); ++i) {
        visit(believers.patches[i], believers.entries.data() + begin, believers.ends[i] - begin);
        begin = believers.ends[i];
      }
    }
  }

 private:
  const Forest* forest_ = nullptr;
  float least_share_ = 0.0F;
  std::vector<Believers> believers_;  // [run * classes + class]
};

/// What the patches believe, by the engine that the settings name. `features`: one image per level. What `beliefs` held
/// is overwritten and its memory used again.
void classify(const Forest& forest, const std::vector<FeatureImage>& features, const PatchGrid& patches,
              const DetectionSettings& settings, PatchBeliefs& beliefs);

}  // namespace houghstream
