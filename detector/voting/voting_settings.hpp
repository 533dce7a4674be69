#pragma once

#include "pipeline/base/settings_fields.hpp"

namespace houghstream {

/// Settings of the voting and of the search for its maxima.
struct VotingSettings {
  float min_mass_fraction = 0.02F;  ///< fraction of a class's expected mass below which a maximum is ignored
  int maxima_per_class = 64;        ///< highest maxima of the Hough image that are refined in 3-D, see per_class_budget
  /// Heaviest of these maxima that are compared with view templates, see per_class_budget.
  int candidates_per_class = 20;
  float min_relative_peak = 0.05F;  ///< fraction of the Hough image's highest value below which a maximum is ignored
  float hough_sigma_px = 3.0F;      ///< smoothing of the Hough image, working pixels
  float vote_sigma = 0.016F;        ///< bandwidth of the 3-D maximum, metres
};

template <typename Visit>
void fields(const VotingSettings& /*settings*/, const Visit& visit) {
  using S = VotingSettings;
  visit(number("min_mass_fraction", &S::min_mass_fraction, 0, 1));
  visit(number("maxima_per_class", &S::maxima_per_class, 1, 1000000));
  visit(number("candidates_per_class", &S::candidates_per_class, 1, 1000000));
  visit(number("min_relative_peak", &S::min_relative_peak, 0, 1));
  visit(number("hough_sigma_px", &S::hough_sigma_px, 0.01, 100, "working pixels"));
  visit(number("vote_sigma", &S::vote_sigma, 1e-6, 10, "m"));
}

}  // namespace houghstream
