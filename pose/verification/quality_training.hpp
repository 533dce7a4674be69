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

/// What the print's margins say of which of the poses that look alike by their shape is right: of the examples that are
/// right up to the shape and have alternatives, by logistic regression with a prior as for fit_quality_settings().
PrintSettings fit_print_settings(const std::vector<QualityExample>& examples, const PrintSettings& prior,
                                 double precision);

/// Bias, weights and typical values that explain the examples best (maximum a posteriori, a Gaussian about each weight
/// of `prior`, as strong as `precision` examples): few examples move them little from there. `least` is the prior's,
/// and so is the weight of seen_through.
QualitySettings fit_quality_settings(const std::vector<QualityExample>& examples, const QualitySettings& prior,
                                     double precision);

/// What the poses of several objects, by name, teach of each: its quality, which is drawn to what they have in common,
/// and what that says of its presence. The latter is learnt from qualities that did not know the examples (those of one
/// half from the other half), as later ones will not.
std::map<std::string, QualitySettings> learn_qualities(
    const std::map<std::string, std::vector<QualityExample>>& examples);

}  // namespace houghstream
