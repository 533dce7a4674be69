#pragma once

#include "detector/detector.hpp"
#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Registers Google Benchmarks of what a frame goes through, one thread each: jpeg, unzip, working_frame, features
/// (whole images), resize_features_leaves, votes, hypotheses. `frame`, `forest` (depth-normalised) and `settings` must
/// live until they have run.
void register_kernels(const RgbdFrame& frame, const Forest& forest, const DetectionSettings& settings);

}  // namespace houghstream
