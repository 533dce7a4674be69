#pragma once

#include "detector/training/augmentation/training_set.hpp"
#include "detector/training/training_settings.hpp"

namespace houghstream::training {

/// Moves those of the set's spare background patches to its samples that a few scout trees take for an object (hard
/// negative mining, Felzenszwalb et al. 2010): blindly drawn background is mostly wall and floor. At most as many as
/// there are background samples already, the most mistaken first; deterministic for any number of threads.
void add_hard_negatives(const PatchSettings& patch, const TrainingSettings& settings, TrainingSet& set);

}  // namespace houghstream::training
