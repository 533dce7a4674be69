#pragma once

#include <cstddef>
#include <cstdint>

#include "detector/features/feature_image.hpp"
#include "detector/forest/packed_trees.hpp"

namespace houghstream {

/// Patches of one image that descend a tree together.
struct PatchBatch {
  const FeatureImage* image = nullptr;
  const std::int16_t* x = nullptr;  ///< working pixels
  const std::int16_t* y = nullptr;
  const std::int32_t* scale = nullptr;  ///< patch_scale
  int count = 0;
};

struct TreeRange {
  std::size_t first = 0;
  std::size_t last = 0;  ///< end of the patches, exclusive
};

/// Finds the leaf of each patch, tree by tree, many patches a step. Returns false, without writing leaves, where no
/// tree is packed or the image is too large for 32-bit offsets. The leaves are those of find_leaf().
bool traverse_batched(const PackedTrees& packed, TreeRange trees, const PatchBatch& patches, std::int32_t* leaves);

}  // namespace houghstream
