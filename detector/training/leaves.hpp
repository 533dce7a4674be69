#pragma once

#include <cstdint>
#include <vector>

#include "detector/forest/forest.hpp"
#include "detector/training/pictures/training_set.hpp"

namespace houghstream::training {

/// What the leaves of one tree are made of.
struct LeafSource {
  const TrainingSet& set;
  const TrainingSettings& settings;
  const std::vector<float>& label_weights;
  float bag_weight;  ///< of all the tree learns from, in units of label_weights
};

/// Appends one leaf made of these samples to the forest's leaf arrays and returns its number. `forest.leaves` must
/// start with a single 0.
std::int32_t add_leaf(const LeafSource& source, const std::vector<std::uint32_t>& samples, Forest& forest);

/// A leaf of a forest to which objects are being added.
struct KnownLeaf {
  const Forest* forest = nullptr;
  std::int32_t leaf = 0;
  float old_share = 1.0F;  ///< of the classes that there will be: those that the forest knew
};

/// Adds to the last leaf of `forest`, which was made of new samples only, what `part` of the known leaf's samples say.
/// Probabilities become those that all classes have when each object weighs the same and the background as much
/// as all of them; the background is the known leaf's.
void mix_in(const KnownLeaf& known, float part, Forest& forest);

/// Appends the known leaf as it is, but for the smaller weight of each object, and returns its number.
std::int32_t copy_leaf(const KnownLeaf& known, Forest& forest);

}  // namespace houghstream::training
