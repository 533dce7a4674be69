#pragma once

#include <cstdint>
#include <vector>

#include "detector/forest/forest.hpp"
#include "detector/training/augmentation/training_set.hpp"
#include "detector/training/training_settings.hpp"

namespace houghstream::training {

/// Inputs of the leaves of one tree.
struct LeafSource {
  const TrainingSet& set;
  const TrainingSettings& settings;
  const std::vector<float>& label_weights;
  float bag_weight;  ///< weight of all samples of the tree, in units of label_weights
};

/// Appends one leaf made of these samples to the forest's leaf arrays and returns its number. `forest.leaves` must
/// start with a single 0.
std::int32_t add_leaf(const LeafSource& source, const std::vector<std::uint32_t>& samples, Forest& forest);

/// Change of a leaf's weight when objects are added.
struct LeafMixture {
  float added = 0.0F;       ///< weight of the new objects' leaf
  float known = 1.0F;       ///< weight of the known leaf's objects
  float background = 1.0F;  ///< weight of the known leaf's background
};

/// Computes the mixture in which each object weighs the same, and the background as
/// TrainingSettings::max_background_weight says.
LeafMixture compute_mixture(float known_classes, float added_classes, float max_background_weight);

/// A leaf of a forest to which objects are being added.
struct ExistingLeaf {
  const Forest* forest = nullptr;
  std::int32_t leaf = 0;
  LeafStart start;
  LeafMixture mixture;
};

/// Adds to the last leaf of `forest`, which was made of new samples only, what `part` of the known leaf's samples say.
/// The background is the known leaf's.
void merge_leaf(const ExistingLeaf& known, float part, Forest& forest);

/// Appends the known leaf as it is, but for the smaller weight of each object, and returns its number.
std::int32_t copy_leaf(const ExistingLeaf& known, Forest& forest);

}  // namespace houghstream::training
