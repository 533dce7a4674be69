#pragma once

#include "detector/training/augmentation/scales.hpp"

namespace houghstream::baseline {

/// How forests with these settings are taught: those of a scale space with the original's training, depth-normalised
/// ones as by the product, and both with surface features where the settings have some.
const training::Scales& scales_of(const FeatureSettings& settings);

}  // namespace houghstream::baseline
