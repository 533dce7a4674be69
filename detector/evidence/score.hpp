#pragma once

#include <cstdint>
#include <limits>

#include "detector/evidence/template_matching.hpp"
#include "detector/forest/forest.hpp"

namespace houghstream {

/// What speaks for and against a hypothesis.
struct Evidence {
  static constexpr std::uint32_t kNoView = std::numeric_limits<std::uint32_t>::max();

  float relative_vote_mass = 0.0F;  ///< vote mass over the class's nominal_vote_mass
  float certainty = 1.0F;           ///< weight of the votes over the number of patches that cast them
  float distance = 1.0F;            ///< of the centre from the camera, metres
  float radius_px = 40.0F;  ///< of the object at that distance, at about the usual focal length: see focal_octave_scale
  std::uint32_t view = kNoView;                           ///< of the forest's: the remembered one that fits best
  Eigen::Vector3f view_centre = Eigen::Vector3f::Zero();  ///< where it is put, camera frame, metres
  TemplateMatch fit;                                      ///< how it fits there
  BoundaryContinuation outline;                           ///< of the same
  float other_size = -0.4F;  ///< see alternative_scale_gain; about what objects have, where it was not looked for
};

/// The evidence as the terms that ScoreModel::weights multiply.
ScoreTerms score_terms(const Evidence& evidence);

/// The model's weighted sum of the terms: the logarithm of the odds that it is an object.
double log_odds(const ScoreModel& model, const ScoreTerms& terms);

/// Probability that the hypothesis is an object of its class (logistic regression, Platt 1999).
float score(const ScoreModel& model, const Evidence& evidence);

/// The score that the hypothesis would have if its chroma differed from what is remembered by as little as that of
/// objects mostly does, whatever the camera makes of it.
float score_as_taught(const ScoreModel& model, const Evidence& evidence);

/// Confidence from votes alone: it rises with their mass and is 0.1 at a twentieth of the expected mass: of
/// an object visible by a tenth, the least that counts as truth, seen half as well as in training.
inline float vote_score(float relative_vote_mass) {
  return relative_vote_mass / (relative_vote_mass + 0.45F);
}

/// A judged hypothesis.
struct ScoreExample {
  ScoreTerms terms{};
  bool is_object = false;
};

/// The weights that explain the examples best (maximum a posteriori, a Gaussian of variance 1 about each weight of
/// `prior`): few examples move them little from there.
ScoreModel fit_score_model(const std::vector<ScoreExample>& examples, const ScoreModel& prior);

}  // namespace houghstream
