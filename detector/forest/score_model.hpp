#pragma once

#include <array>

namespace houghstream {

/// One number for each thing that a score weighs: what score_terms() makes of the evidence, or the weights that
/// multiply it. Of all products of two measures those that are here helped most on development worlds.
struct ScoreTerms {
  float constant = 0.0F;
  float mass = 0.0F;            ///< logarithm of the vote mass over the expected one
  float shown = 0.0F;           ///< logarithm of what is not hidden: half an object has half the mass
  float seen_through = 0.0F;    ///< share of the view's surface behind which something is measured
  float unknown = 0.0F;         ///< share without depth
  float continued = 0.0F;       ///< share of the rim beyond which the surface goes on
  float likeness = 0.0F;        ///< correlation of colours
  float hue_conflict = 0.0F;    ///< see Likeness
  float foreign_colour = 0.0F;  ///< squared: light makes a little of it
  float unevenness = 0.0F;      ///< error of the visible depth
  // What is mostly unknown: mass and likeness say something else there, and near surfaces lose their depth, far ones
  // seldom.
  float unknown_mass = 0.0F;
  float unknown_likeness = 0.0F;
  float unknown_distance = 0.0F;       ///< with the distance's logarithm
  float likeness_hue_conflict = 0.0F;  ///< print of other colours may be as like as can be
  float other_size = 0.0F;             ///< gain of another size, see alternative_scale_gain
  float certainty = 0.0F;              ///< logarithm: as many votes of patches that are less sure come from elsewhere
  // Products for which those above are too straight.
  float shown_sq = 0.0F;
  float other_size_sq = 0.0F;
  float seen_through_certainty = 0.0F;
  float hue_conflict_foreign_colour = 0.0F;
  float unevenness_sq = 0.0F;
  // How well the object can be seen: what is small or faint looks less like itself than what is large and clear.
  float extent = 0.0F;           ///< logarithm of its radius in pixels, over 40
  float contrast = 0.0F;         ///< see Likeness
  float extent_likeness = 0.0F;  ///< products
  float contrast_likeness = 0.0F;
  float paleness = 0.0F;  ///< see Likeness
  // Whether it ends where its outline is, see BoundaryContinuation.
  float goes_on = 0.0F;
  float surface_goes_on = 0.0F;
  float colour_goes_on = 0.0F;
  float boundary_continuation_correlation = 0.0F;  ///< product
};

constexpr std::size_t kScoreTerms = 30;

/// All of them, in the order in which the fit sums them and the forest file holds them.
constexpr std::array<float ScoreTerms::*, kScoreTerms> kScoreTermList = {
    &ScoreTerms::constant,
    &ScoreTerms::mass,
    &ScoreTerms::shown,
    &ScoreTerms::seen_through,
    &ScoreTerms::unknown,
    &ScoreTerms::continued,
    &ScoreTerms::likeness,
    &ScoreTerms::hue_conflict,
    &ScoreTerms::foreign_colour,
    &ScoreTerms::unevenness,
    &ScoreTerms::unknown_mass,
    &ScoreTerms::unknown_likeness,
    &ScoreTerms::unknown_distance,
    &ScoreTerms::likeness_hue_conflict,
    &ScoreTerms::other_size,
    &ScoreTerms::certainty,
    &ScoreTerms::shown_sq,
    &ScoreTerms::other_size_sq,
    &ScoreTerms::seen_through_certainty,
    &ScoreTerms::hue_conflict_foreign_colour,
    &ScoreTerms::unevenness_sq,
    &ScoreTerms::extent,
    &ScoreTerms::contrast,
    &ScoreTerms::extent_likeness,
    &ScoreTerms::contrast_likeness,
    &ScoreTerms::paleness,
    &ScoreTerms::goes_on,
    &ScoreTerms::surface_goes_on,
    &ScoreTerms::colour_goes_on,
    &ScoreTerms::boundary_continuation_correlation};
static_assert(sizeof(ScoreTerms) == kScoreTerms * sizeof(float), "a term is missing in the list");

/// Their names, in the order of the list.
constexpr std::array<const char*, kScoreTerms> kScoreTermNames = {"constant",
                                                                  "mass",
                                                                  "shown",
                                                                  "seen_through",
                                                                  "unknown",
                                                                  "continued",
                                                                  "likeness",
                                                                  "hue_conflict",
                                                                  "foreign_colour",
                                                                  "unevenness",
                                                                  "unknown_mass",
                                                                  "unknown_likeness",
                                                                  "unknown_distance",
                                                                  "likeness_hue_conflict",
                                                                  "other_size",
                                                                  "certainty",
                                                                  "shown_sq",
                                                                  "other_size_sq",
                                                                  "seen_through_certainty",
                                                                  "hue_conflict_foreign_colour",
                                                                  "unevenness_sq",
                                                                  "extent",
                                                                  "contrast",
                                                                  "extent_likeness",
                                                                  "contrast_likeness",
                                                                  "paleness",
                                                                  "goes_on",
                                                                  "surface_goes_on",
                                                                  "colour_goes_on",
                                                                  "goes_on_likeness"};
static_assert(kScoreTermNames.back() != nullptr, "a term has no name");

/// The weights that are assumed before any example is seen: what sixteen household objects have in common. hs-teach
/// learnt them from 64257 hypotheses, 3599 of them true, in 240 practice rooms each of two stores of seven and nine
/// objects of `hs-render training --objects all_20` (`hs-teach practise -v` says what a store's objects have in
/// common).
constexpr ScoreTerms prior_weights() {
  ScoreTerms weights;
  weights.constant = 3.04F;
  weights.mass = 1.76F;
  weights.shown = 1.36F;
  weights.seen_through = -3.15F;
  weights.unknown = 1.07F;
  weights.continued = -1.88F;
  weights.likeness = 3.95F;
  weights.hue_conflict = -4.81F;
  weights.foreign_colour = -1.73F;
  weights.unevenness = -1.32F;
  weights.unknown_mass = -0.44F;
  weights.unknown_likeness = 1.21F;
  weights.unknown_distance = 0.49F;
  weights.likeness_hue_conflict = -2.57F;
  weights.other_size = -2.95F;
  weights.certainty = 0.18F;
  weights.shown_sq = 0.46F;
  weights.other_size_sq = -1.56F;
  weights.seen_through_certainty = -0.71F;
  weights.hue_conflict_foreign_colour = 1.40F;
  weights.unevenness_sq = -1.22F;
  weights.extent = 1.66F;
  weights.contrast = 0.20F;
  weights.extent_likeness = -0.70F;
  weights.contrast_likeness = -0.39F;
  weights.paleness = 0.26F;
  weights.goes_on = -3.37F;
  weights.surface_goes_on = -2.93F;
  weights.colour_goes_on = -4.99F;
  weights.boundary_continuation_correlation = -3.65F;
  return weights;
}

/// How evidence becomes a probability: the weights of its terms, each object's own. hs-train learns them
/// (training/score_training.hpp) on pictures that it composes of the training views.
struct ScoreModel {
  ScoreTerms weights = prior_weights();
};

}  // namespace houghstream
