#pragma once

#include <cstdint>
#include <vector>

#include "detector/forest/forest.hpp"
#include "detector/training/pictures/training_set.hpp"

namespace houghstream {

/// Appends one leaf made of these samples to the forest's leaf arrays and returns its number. `forest.leaves` must
/// start with a single 0. `bag_weight`: of all the tree learns from, in units of label_weights.
std::int32_t add_leaf(const TrainingSet& set, const std::vector<std::uint32_t>& samples,
                      const std::vector<float>& label_weights, float bag_weight, const TrainingSettings& settings,
                      Forest& forest);

}  // namespace houghstream
