#pragma once

#include <optional>
#include <vector>

namespace houghstream {

/// A predicted probability, a score or a quality, and whether it came true.
struct Prediction {
  double confidence = 0.0;
  bool is_true = false;
};

/// Predictions of about the same probability.
struct ReliabilityBin {
  double from = 0.0;
  double to = 0.0;  ///< excluded, but 1 in the last one
  int count = 0;
  double mean_score = 0.0;     ///< NaN where it is empty
  double true_fraction = 0.0;  ///< NaN where it is empty
};

/// Threshold from which on a wanted precision is kept.
struct ProposedThreshold {
  double precision = 0.0;
  /// Smallest prediction from which on that fraction or more is true; nothing: there is none.
  std::optional<double> score;
  double recall = 0.0;  ///< true predictions from there on, over all that could be; NaN without a score
};

/// Calibration of predicted probabilities (Guo et al., "On Calibration of Modern Neural Networks", ICML 2017).
struct Calibration {
  int count = 0;
  /// Expected calibration error: the bins' differences between mean score and true fraction, each weighted by its
  /// count; NaN without predictions.
  double ece = 0.0;
  std::vector<ReliabilityBin> bins;         ///< ten of equal width
  std::vector<ProposedThreshold> proposed;  ///< for precisions of 0.90, 0.95, 0.98 and 0.99
};

/// Computes the calibration. `could_be_true` is the number that a recall of 1 means.
Calibration calibrate(const std::vector<Prediction>& statements, int could_be_true);

}  // namespace houghstream
