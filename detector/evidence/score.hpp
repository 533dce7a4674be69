#pragma once

#include "detector/evidence/view_fit.hpp"
#include "detector/forest/forest.hpp"

namespace houghstream {

/// What speaks for and against a hypothesis.
struct Evidence {
  float mass_share = 0.0F;   ///< vote mass over the class's expected_mass
  float certainty = 1.0F;    ///< weight of the votes over the number of patches that cast them
  float distance = 1.0F;     ///< of the centre from the camera, metres
  ViewFit fit;               ///< of the remembered view that fits best
  float other_size = -0.4F;  ///< see gain_of_other_size; about what objects have, where it was not looked for
};

/// The evidence as the terms that ScoreModel::weights multiply: 1; the measures, which are the logarithms of the mass
/// and of what is not hidden (half an object has half the mass), what is seen through, unknown and continued, likeness
/// and hue conflict, foreign colour, of which light makes a little, squared, unevenness, the gain of another size, and
/// the logarithm of the certainty: as many votes of patches that are less sure come from something else; the share of
/// unknown depth times the distance's logarithm, since near surfaces lose their depth, far ones seldom; and the
/// measures' products and squares, each with itself and those after it: mass says less of what is mostly unknown,
/// likeness less in other hues, and what is much hidden can be little like.
ScoreTerms score_terms(const Evidence& evidence);

/// Probability that the hypothesis is an object of its class (logistic regression, Platt 1999, on quadratic terms).
float score(const ScoreModel& model, const Evidence& evidence);

/// Confidence from votes alone: it rises with their mass and is 0.1 at a twentieth of the expected mass: of
/// an object visible by a tenth, the least that counts as truth, seen half as well as in training.
inline float vote_score(float mass_share) {
  return mass_share / (mass_share + 0.45F);
}

/// A judged hypothesis.
struct ScoreExample {
  ScoreTerms terms{};
  bool is_object = false;
};

/// The weights that explain the examples best; few examples move them little from those of `prior`.
ScoreModel fit_score_model(const std::vector<ScoreExample>& examples, const ScoreModel& prior);

}  // namespace houghstream
