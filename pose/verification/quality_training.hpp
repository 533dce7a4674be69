#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pose/verification/quality.hpp"

namespace houghstream {

/// A judged pose.
struct QualityExample {
  QualityTerms terms;
  bool is_correct = false;              ///< the object that was detected, MSSD (or ADD) below a tenth of the diameter
  bool is_correct_up_to_shape = false;  ///< the same by ADD-S: right but for what the shape cannot tell
  /// Of a pose that is right up to its shape, what speaks for it if the object had another print: the fit tells the two
  /// apart.
  std::optional<QualityTerms> with_swapped_texture = std::nullopt;
  std::optional<double> print_margin = std::nullopt;  ///< PrintComparison::margin, where the pose has alternatives
  float score = 0.0F;                                 ///< of the detection
  bool is_present = false;  ///< the object that was detected, whether the pose is right or not
  int half = 0;             ///< 0 or 1: of which half of all that was practised
};

/// Fits the probability of the texture's margins by logistic regression over the examples that are correct up to their
/// shape and have alternatives, with a prior as for fit_quality_settings().
PrintSettings fit_print_settings(const std::vector<QualityExample>& examples, const PrintSettings& prior,
                                 double precision);

/// Bias, weights and typical values that explain the examples best (maximum a posteriori, a Gaussian about each weight
/// of `prior`, as strong as `precision` examples): few examples move them little from there. `least` is the prior's,
/// and so is the weight of seen_through.
QualitySettings fit_quality_settings(const std::vector<QualityExample>& examples, const QualitySettings& prior,
                                     double precision);

/// Learns the quality settings of several objects from their poses, by name, with the objects' common weights as a
/// prior, and the presence settings from these qualities. The latter use cross-fitted qualities (those of one half from
/// the other half), since later ones will not have been trained on their examples either.
std::map<std::string, QualitySettings> learn_qualities(
    const std::map<std::string, std::vector<QualityExample>>& examples);

}  // namespace houghstream
