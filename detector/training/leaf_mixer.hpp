#pragma once

#include <cstdint>

#include "detector/forest/forest.hpp"

namespace houghstream {

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

}  // namespace houghstream
