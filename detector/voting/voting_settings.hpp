#pragma once

namespace houghstream {

/// How votes are cast and their maxima found.
struct VotingSettings {
  float min_mass_share = 0.02F;     ///< of a class's expected mass, for a maximum to be looked at
  int maxima_per_class = 64;        ///< highest of the Hough image that are looked at in 3-D, see per_class_budget
  int candidates_per_class = 20;    ///< heaviest of these that are compared with remembered views, see per_class_budget
  float min_relative_peak = 0.05F;  ///< of the Hough image's highest value, for a maximum to be looked at
  float hough_sigma_px = 3.0F;      ///< smoothing of the Hough image, working pixels
  float vote_sigma = 0.016F;        ///< bandwidth of the 3-D maximum, metres
};

/// Which of two overlapping detections stays (non-maximum suppression).
struct SuppressionSettings {
  float max_overlap = 0.5F;  ///< a weaker box of another object may overlap a stronger one by this IoU
  /// ... if that one is more likely than not and so many times as likely; of its own class always.
  float dominance = 2.0F;
};

}  // namespace houghstream
