#pragma once

#include "detector/engine.hpp"

namespace houghstream::baseline {

/// Features plane by plane (reference_features), leaves patch by patch and tree by tree (find_leaf), with one thread
/// for each run of patches: the same as the fast engine's, but slowly.
const Engine& reference_engine();

}  // namespace houghstream::baseline
