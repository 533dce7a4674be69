#pragma once

#include "detector/detection_settings.hpp"
#include "detector/forest/forest_index.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Registers Google Benchmarks of what a frame goes through, one thread each: jpeg, unzip, working_frame, features
/// (whole images), resize_features_leaves, votes, hypotheses. `frame`, `index` (of a depth-normalised forest) and
/// `settings` must live until they have run.
void register_kernels(const RgbdFrame& frame, const ForestIndex& index, const DetectionSettings& settings);

}  // namespace houghstream
