#pragma once

#include <vector>

#include "tools/studies/tracks/matching.hpp"

namespace houghstream::studies {

/// Of one threshold of similarity.
struct HotaCount {
  double true_positives = 0.0;
  double false_negatives = 0.0;
  double false_positives = 0.0;
  double association = 0.0;  ///< sum over the true positives of A(c)
};

/// Higher Order Tracking Accuracy (Luiten et al., "HOTA: A Higher Order Metric for Evaluating Multi-Object Tracking",
/// IJCV 2021), as the authors' TrackEval counts it, at thresholds 0.05 to 0.95: in each frame true and published
/// objects are given to one another once, for all thresholds, so that the sum of similarity times the global alignment
/// of their tracks is greatest. Similarity is 1 - distance / 0.1 m. Published objects that are given (matches()) to a
/// true one that need not be seen are left out before, with that one.
std::vector<HotaCount> hota_counts(const SequenceFile& sequence, const std::vector<PublishedFrame>& published,
                                   const ClassSymmetries& symmetries, const TrackMetricsSettings& settings);

/// Mean over the thresholds of sqrt(DetA AssA). Counts of several sequences may be added up before.
double hota_of(const std::vector<HotaCount>& counts);

}  // namespace houghstream::studies
