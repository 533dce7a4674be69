#pragma once

#include "detector/training/augmentation/scales.hpp"

namespace houghstream::baseline {

/// Returns the scales with which forests of these settings are trained: a scale space as in the original, depth
/// normalisation as in the product, each with surface features where the settings have some.
const training::Scales& scales_of(const FeatureSettings& settings);

}  // namespace houghstream::baseline
