#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pose/verification/quality.hpp"

namespace houghstream {

/// Holds a pose whose correctness is known.
struct QualityExample {
  QualityTerms terms;
  bool is_correct = false;              ///< the object that was detected, MSSD (or ADD) below a tenth of the diameter
  bool is_correct_up_to_shape = false;  ///< whether it is correct by ADD-S, up to the symmetries of the shape
  /// Evidence of a pose that is correct up to its shape if the object had another texture: the fit separates the two.
  std::optional<QualityTerms> with_swapped_texture = std::nullopt;
  std::optional<double> texture_margin = std::nullopt;  ///< TextureComparison::margin, where the pose has alternatives
  float score = 0.0F;                                   ///< score of the detection
  bool is_present = false;  ///< the object that was detected, whether the pose is right or not
  int fold = 0;             ///< 0 or 1: fold of the two-fold cross-validation
};

/// Fits the probability of the texture's margins by logistic regression over the examples that are correct up to their
/// shape and have alternatives, with a prior as for fit_quality_settings().
TextureSettings fit_texture_settings(const std::vector<QualityExample>& examples, const TextureSettings& prior,
                                     double precision);

/// Fits the bias, weights and mean terms that explain the examples best (maximum a posteriori, with a Gaussian about
/// each weight of `prior`, as strong as `precision` examples): few examples move them little from there. `min_quality`
/// is the prior's, and so is the weight of `free_space_violation`.
QualitySettings fit_quality_settings(const std::vector<QualityExample>& examples, const QualitySettings& prior,
                                     double precision);

/// Returns the shape quality of each example, in their order, by settings that are fitted to the other fold: as
/// uncertain as that of a pose that the fit has not seen.
std::map<std::string, std::vector<float>> cross_fitted_qualities(
    const std::map<std::string, std::vector<QualityExample>>& examples);

/// Learns the quality settings of several objects from their poses, by name, with the objects' common weights as a
/// prior, and the presence settings from these qualities. The latter use cross-fitted qualities (those of one fold from
/// the other fold), since later ones will not have been trained on their examples either.
std::map<std::string, QualitySettings> learn_qualities(
    const std::map<std::string, std::vector<QualityExample>>& examples);

}  // namespace houghstream
