#pragma once

#include <cstdint>
#include <limits>

#include "detector/evidence/template_matching.hpp"
#include "detector/forest/forest.hpp"

namespace houghstream {

/// Evidence for and against a hypothesis, from votes, depth and colour.
struct Evidence {
  static constexpr std::uint32_t kNoView = std::numeric_limits<std::uint32_t>::max();

  float relative_vote_mass = 0.0F;  ///< vote mass over the class's nominal_vote_mass
  float certainty = 1.0F;           ///< weight of the votes over the number of patches that cast them
  float distance = 1.0F;            ///< distance of the centre from the camera, metres
  /// Radius of the object at that distance, pixels of a camera whose focal length is brought by powers of two nearest
  /// to the reference (focal_octave_scale).
  float radius_px = 40.0F;
  std::uint32_t view = kNoView;                           ///< index of the best template into Forest::views
  Eigen::Vector3f view_centre = Eigen::Vector3f::Zero();  ///< place of its centre, camera frame, metres
  TemplateMatch fit;                                      ///< its match there
  BoundaryContinuation outline;                           ///< continuation across its outline
  /// Result of alternative_scale_gain(); the default is typical of true objects.
  float alternative_scale_gain = -0.4F;
};

/// Returns the evidence as the terms that ScoreModel::weights multiply.
ScoreTerms score_terms(const Evidence& evidence);

/// Returns the model's weighted sum of the terms: the log odds that the hypothesis is an object.
double score_logit(const ScoreModel& model, const ScoreTerms& terms);

/// Returns the probability that the hypothesis is an object of its class (logistic regression, Platt 1999).
float score(const ScoreModel& model, const Evidence& evidence);

/// Returns the score that the hypothesis would have if its chroma differed from the template's by as little as that of
/// objects mostly does, whatever the camera makes of it.
float score_with_typical_chroma(const ScoreModel& model, const Evidence& evidence);

/// Returns a score from votes alone. It rises with their mass and is 0.1 at a twentieth of the nominal mass: that of an
/// object of which a tenth is visible, the least that counts as ground truth, seen half as well as in training.
inline float vote_score(float relative_vote_mass) {
  return relative_vote_mass / (relative_vote_mass + 0.45F);
}

/// Returns the log odds that a hypothesis is an object by its votes alone, up to a constant, by which hypotheses are
/// ranked before any template is compared. Logistic regression on 9801 hypotheses of 21 objects in 48 images of
/// furnished rooms, 193 of them objects.
double vote_logit(const Evidence& evidence);

/// A hypothesis with its label.
struct ScoreExample {
  ScoreTerms terms{};
  bool is_object = false;
};

/// Returns the weights that explain the examples best (maximum a posteriori, a Gaussian of variance 1 about each weight
/// of `prior`): few examples move them little from there.
ScoreModel fit_score_model(const std::vector<ScoreExample>& examples, const ScoreModel& prior);

}  // namespace houghstream
