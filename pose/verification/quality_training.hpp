#pragma once

#include <optional>
#include <vector>

#include "pose/verification/quality.hpp"

namespace houghstream {

/// A judged pose.
struct QualityExample {
  QualityTerms terms;
  bool is_right = false;  ///< the object that was detected, ADD-S below a tenth of the diameter
  /// Of a right pose, what speaks for it if the object had another print: the fit tells the two apart.
  std::optional<QualityTerms> of_other_print = std::nullopt;
};

/// Bias, weights and typical values that explain the examples best (maximum a posteriori, a Gaussian about each weight
/// of `prior`, as strong as `stiffness` examples): few examples move them little from there. `least` is the prior's.
QualitySettings fit_quality_settings(const std::vector<QualityExample>& examples, const QualitySettings& prior,
                                     double stiffness);

}  // namespace houghstream
