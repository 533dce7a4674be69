#pragma once

#include "detector/forest/forest.hpp"
#include "detector/training/augmentation/training_set.hpp"
#include "detector/training/training_settings.hpp"

namespace houghstream::training {

/// Returns whether a tree learns from an image. Whole images are in the bag or out, since patches of one image are not
/// independent; out-of-bag images test the tree (Breiman 2001).
bool in_bag(const TrainingSettings& settings, int tree, std::int32_t image);

/// Grows tree number `tree` alone: a forest of one. Depends on the seed and the tree's number only.
Forest grow_tree(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings, int tree);

/// Returns tree number `tree` of `old`, alone, that has learnt the set's classes beside those it knew. set.first_class
/// and set.first_view must be the numbers of old's classes and views.
Forest regrow_tree(const TrainingSet& set, const PatchSettings& patch, const TrainingSettings& settings, int tree,
                   const Forest& old);

}  // namespace houghstream::training
