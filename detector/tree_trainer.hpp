#pragma once

#include "detector/forest.hpp"
#include "detector/training_set.hpp"

namespace houghstream {

/// Grows tree number `tree` alone: a forest of one. Depends on the seed and the tree's number only.
Forest grow_tree(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings, int tree);

}  // namespace houghstream
