#pragma once

#include "detector/stages.hpp"

namespace houghstream::baseline {

/// Functions that compute features and leaves. Both ways find the same, bit for bit.
enum class Way {
  kFast,       ///< functions of the product: compute_features and find_posteriors
  kReference,  ///< slow ones to hold these against: features plane by plane (reference_features), leaves patch by patch
               ///< and tree by tree (find_leaf), with one thread for each run of patches
};

/// Computes features; surface families are computed too, and FeatureInput::extra is not asked.
void compute_features_by(Way way, const FeatureInput& input, int threads, FeatureWorkspace& workspace,
                         FeatureImage& image);
/// Runs the stage compute_features.
void compute_features_by(Way way, const SearchContext& search, DetectorWorkspace& workspace);

void find_posteriors_by(Way way, const PosteriorInput& input, LeafWorkspace& workspace, PatchPosteriors& posteriors);

/// Finds the leaves of find_leaves, by find_leaf alone.
void reference_leaves(const LeafInput& input, int threads, const LeafVisitor& visit);

}  // namespace houghstream::baseline
