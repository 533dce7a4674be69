#pragma once

#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

/// Early rejection of patches, and the classes that the others vote for.
struct LeafSettings {
  /// A patch walks down so many trees first, and down the rest only if the mean of what their leaves are most certain
  /// of reaches min_first_posterior; 0 = every patch walks down all trees.
  int first_trees = 3;
  float min_first_posterior = 0.1F;
  float min_class_fraction = 0.1F;  ///< posterior, p(class | patch), from which a patch votes for a class
};

template <typename Visit>
void fields(const LeafSettings& /*settings*/, const Visit& visit) {
  using S = LeafSettings;
  visit(number("first_trees", &S::first_trees, 0, 1000));
  visit(number("min_first_posterior", &S::min_first_posterior, 0, 1));
  visit(number("min_class_fraction", &S::min_class_fraction, 0, 1));
}

}  // namespace houghstream
