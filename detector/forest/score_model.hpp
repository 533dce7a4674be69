#pragma once

#include <array>

namespace houghstream {

/// Terms of the logistic regression, as score_terms() computes them from the evidence, or the weights of these terms.
/// Of all products of two measures the ones listed here reduced the loss most in rendered rooms (hs-render, for
/// development).
struct ScoreTerms {
  float constant = 0.0F;
  float log_vote_mass = 0.0F;         ///< logarithm of the vote mass over the expected one
  float log_visible = 0.0F;           ///< logarithm of the fraction that is not occluded: half an object, half the mass
  float free_space_violation = 0.0F;  ///< fraction of the view's surface behind which something is measured
  float no_depth = 0.0F;              ///< fraction without depth
  float rim_continuation = 0.0F;      ///< fraction of the rim beyond which the surface continues
  float colour_correlation = 0.0F;    ///< correlation of colours
  float hue_mismatch = 0.0F;          ///< see ColourSimilarity
  float mean_chroma_distance = 0.0F;  ///< squared: light makes a little of it
  float depth_residual = 0.0F;        ///< error of the visible depth
  // Vote mass and colour correlation of an object that is mostly without depth are distributed differently, and near
  // surfaces lose their depth more often than far ones.
  float no_depth_log_vote_mass = 0.0F;
  float no_depth_colour_correlation = 0.0F;
  float no_depth_distance = 0.0F;                ///< product with the distance's logarithm
  float colour_correlation_hue_mismatch = 0.0F;  ///< texture of other colours may correlate as well as can be
  float alternative_scale_gain = 0.0F;           ///< gain of another size, see alternative_scale_gain
  float log_certainty = 0.0F;  ///< logarithm: as many votes of patches that are less sure come from elsewhere
  // Products stand where the terms above are not linear in the logit.
  float log_visible_sq = 0.0F;
  float alternative_scale_gain_sq = 0.0F;
  float free_space_violation_log_certainty = 0.0F;
  float hue_mismatch_chroma_distance = 0.0F;
  float depth_residual_sq = 0.0F;
  // Visibility of the object: small or faint objects match their templates less well than large and clear ones.
  float extent = 0.0F;                     ///< logarithm of its radius in pixels, over 40
  float log_contrast_ratio = 0.0F;         ///< see ColourSimilarity
  float extent_colour_correlation = 0.0F;  ///< products
  float contrast_colour_correlation = 0.0F;
  float chroma_deficit = 0.0F;  ///< see ColourSimilarity
  // Continuation of the scene across the outline, see BoundaryContinuation.
  float boundary_continuation = 0.0F;  ///< of surface and colour at once
  float surface_continuation = 0.0F;
  float colour_continuation = 0.0F;
  float boundary_continuation_correlation = 0.0F;  ///< product
};

constexpr std::size_t kScoreTerms = 30;

/// The terms in the order in which the fit sums them and the forest file stores them.
constexpr std::array<float ScoreTerms::*, kScoreTerms> kScoreTermList = {
    &ScoreTerms::constant,
    &ScoreTerms::log_vote_mass,
    &ScoreTerms::log_visible,
    &ScoreTerms::free_space_violation,
    &ScoreTerms::no_depth,
    &ScoreTerms::rim_continuation,
    &ScoreTerms::colour_correlation,
    &ScoreTerms::hue_mismatch,
    &ScoreTerms::mean_chroma_distance,
    &ScoreTerms::depth_residual,
    &ScoreTerms::no_depth_log_vote_mass,
    &ScoreTerms::no_depth_colour_correlation,
    &ScoreTerms::no_depth_distance,
    &ScoreTerms::colour_correlation_hue_mismatch,
    &ScoreTerms::alternative_scale_gain,
    &ScoreTerms::log_certainty,
    &ScoreTerms::log_visible_sq,
    &ScoreTerms::alternative_scale_gain_sq,
    &ScoreTerms::free_space_violation_log_certainty,
    &ScoreTerms::hue_mismatch_chroma_distance,
    &ScoreTerms::depth_residual_sq,
    &ScoreTerms::extent,
    &ScoreTerms::log_contrast_ratio,
    &ScoreTerms::extent_colour_correlation,
    &ScoreTerms::contrast_colour_correlation,
    &ScoreTerms::chroma_deficit,
    &ScoreTerms::boundary_continuation,
    &ScoreTerms::surface_continuation,
    &ScoreTerms::colour_continuation,
    &ScoreTerms::boundary_continuation_correlation};
static_assert(sizeof(ScoreTerms) == kScoreTerms * sizeof(float), "a term is missing in the list");

/// Names of the terms, in the order of kScoreTermList.
constexpr std::array<const char*, kScoreTerms> kScoreTermNames = {"constant",
                                                                  "log_vote_mass",
                                                                  "log_visible",
                                                                  "free_space_violation",
                                                                  "no_depth",
                                                                  "rim_continuation",
                                                                  "colour_correlation",
                                                                  "hue_mismatch",
                                                                  "mean_chroma_distance",
                                                                  "depth_residual",
                                                                  "no_depth_log_vote_mass",
                                                                  "no_depth_colour_correlation",
                                                                  "no_depth_distance",
                                                                  "colour_correlation_hue_mismatch",
                                                                  "alternative_scale_gain",
                                                                  "log_certainty",
                                                                  "log_visible_sq",
                                                                  "alternative_scale_gain_sq",
                                                                  "free_space_violation_log_certainty",
                                                                  "hue_mismatch_chroma_distance",
                                                                  "depth_residual_sq",
                                                                  "extent",
                                                                  "log_contrast_ratio",
                                                                  "extent_colour_correlation",
                                                                  "contrast_colour_correlation",
                                                                  "chroma_deficit",
                                                                  "boundary_continuation",
                                                                  "surface_continuation",
                                                                  "colour_continuation",
                                                                  "boundary_continuation_correlation"};
static_assert(kScoreTermNames.back() != nullptr, "a term has no name");

/// Returns the prior weights: the ones that sixteen household objects have in common. hs-teach learnt them from 64257
/// hypotheses, 3599 of them true positives, in 240 synthetic scenes for each of two stores of seven and nine objects of
/// `hs-render training --objects all_20` (`hs-teach practise -v` prints the common weights of a store's objects).
constexpr ScoreTerms prior_weights() {
  ScoreTerms weights;
  weights.constant = 3.04F;
  weights.log_vote_mass = 1.76F;
  weights.log_visible = 1.36F;
  weights.free_space_violation = -3.15F;
  weights.no_depth = 1.07F;
  weights.rim_continuation = -1.88F;
  weights.colour_correlation = 3.95F;
  weights.hue_mismatch = -4.81F;
  weights.mean_chroma_distance = -1.73F;
  weights.depth_residual = -1.32F;
  weights.no_depth_log_vote_mass = -0.44F;
  weights.no_depth_colour_correlation = 1.21F;
  weights.no_depth_distance = 0.49F;
  weights.colour_correlation_hue_mismatch = -2.57F;
  weights.alternative_scale_gain = -2.95F;
  weights.log_certainty = 0.18F;
  weights.log_visible_sq = 0.46F;
  weights.alternative_scale_gain_sq = -1.56F;
  weights.free_space_violation_log_certainty = -0.71F;
  weights.hue_mismatch_chroma_distance = 1.40F;
  weights.depth_residual_sq = -1.22F;
  weights.extent = 1.66F;
  weights.log_contrast_ratio = 0.20F;
  weights.extent_colour_correlation = -0.70F;
  weights.contrast_colour_correlation = -0.39F;
  weights.chroma_deficit = 0.26F;
  weights.boundary_continuation = -3.37F;
  weights.surface_continuation = -2.93F;
  weights.colour_continuation = -4.99F;
  weights.boundary_continuation_correlation = -3.65F;
  return weights;
}

/// Weights of the logistic regression that turns evidence into a probability, for each object. hs-train learns them
/// (training/score_training.hpp) on images composed of the training views.
struct ScoreModel {
  ScoreTerms weights = prior_weights();
};

}  // namespace houghstream
