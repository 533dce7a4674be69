#include "detector/evidence/score.hpp"

#include <algorithm>
#include <cmath>

#include "pipeline/base/logistic_regression.hpp"

namespace houghstream {
namespace {

using Vector = Eigen::Matrix<double, kScoreTerms, 1>;

Vector to_vector(const ScoreTerms& terms) {
  Vector out;
  for (std::size_t i = 0; i < kScoreTerms; ++i) out(static_cast<Eigen::Index>(i)) = terms.*kScoreTermList[i];
  return out;
}

}  // namespace

ScoreTerms score_terms(const Evidence& evidence) {
  const TemplateMatch& fit = evidence.fit;
  const float chroma_distance = std::min(fit.mean_chroma_distance, 1.0F);
  constexpr float kMinDistance_m = 0.1F;  // metres, the smallest distance whose logarithm means something
  constexpr float kMinFraction = 1e-4F;   // smallest fraction whose logarithm means something
  constexpr float kReferenceRadius_px = 40.0F;
  const float log_vote_mass = std::log(std::max(evidence.relative_vote_mass, kMinFraction));
  const float log_visible = std::log(1.02F - fit.occluded_fraction);
  const float log_certainty = std::log(std::max(evidence.certainty, kMinFraction));
  ScoreTerms terms;
  terms.constant = 1.0F;
  terms.log_vote_mass = log_vote_mass;
  terms.log_visible = log_visible;
  terms.free_space_violation = fit.free_space_violation;
  terms.no_depth = fit.no_depth_fraction;
  terms.rim_continuation = fit.rim_continuation;
  terms.colour_correlation = fit.colour_correlation;
  terms.hue_mismatch = fit.hue_mismatch;
  terms.mean_chroma_distance = chroma_distance * chroma_distance;
  terms.depth_residual = fit.depth_residual;
  terms.no_depth_log_vote_mass = fit.no_depth_fraction * log_vote_mass;
  terms.no_depth_colour_correlation = fit.no_depth_fraction * fit.colour_correlation;
  terms.no_depth_distance = fit.no_depth_fraction * std::log(std::max(evidence.distance, kMinDistance_m));
  terms.colour_correlation_hue_mismatch = fit.colour_correlation * fit.hue_mismatch;
  terms.alternative_scale_gain = evidence.alternative_scale_gain;
  terms.log_certainty = log_certainty;
  terms.log_visible_sq = log_visible * log_visible;
  terms.alternative_scale_gain_sq = evidence.alternative_scale_gain * evidence.alternative_scale_gain;
  terms.free_space_violation_log_certainty = fit.free_space_violation * log_certainty;
  terms.hue_mismatch_chroma_distance = fit.hue_mismatch * chroma_distance * chroma_distance;
  terms.depth_residual_sq = fit.depth_residual * fit.depth_residual;
  terms.extent = std::log(std::max(evidence.radius_px, 1.0F) / kReferenceRadius_px);
  terms.log_contrast_ratio = fit.log_contrast_ratio;
  terms.extent_colour_correlation = terms.extent * fit.colour_correlation;
  terms.contrast_colour_correlation = fit.log_contrast_ratio * fit.colour_correlation;
  terms.chroma_deficit = fit.chroma_deficit;
  terms.boundary_continuation = evidence.outline.joint();
  terms.surface_continuation = evidence.outline.surface();
  terms.colour_continuation = evidence.outline.colour();
  terms.boundary_continuation_correlation = terms.boundary_continuation * fit.colour_correlation;
  return terms;
}

double score_logit(const ScoreModel& model, const ScoreTerms& terms) {
  return to_vector(model.weights).dot(to_vector(terms));
}

float score(const ScoreModel& model, const Evidence& evidence) {
  return static_cast<float>(logistic(score_logit(model, score_terms(evidence))));
}

float score_with_typical_chroma(const ScoreModel& model, const Evidence& evidence) {
  Evidence as_taught = evidence;
  as_taught.fit.mean_chroma_distance = 0.2F;
  as_taught.fit.hue_mismatch = 0.1F;
  as_taught.fit.chroma_deficit = 0.2F;
  return score(model, as_taught);
}

double vote_logit(const Evidence& evidence) {
  const ScoreTerms terms = score_terms(evidence);
  return 2.8 * terms.log_vote_mass + 0.7 * terms.log_certainty + 1.4 * terms.extent;
}

ScoreModel fit_score_model(const std::vector<ScoreExample>& examples, const ScoreModel& prior) {
  std::vector<LogisticExample<kScoreTerms>> labelled;
  labelled.reserve(examples.size());
  for (const ScoreExample& example : examples) labelled.push_back({to_vector(example.terms), example.is_object});
  constexpr double kPriorPrecision = 1.0;
  const Vector weights = fit_logistic<kScoreTerms>(labelled, {to_vector(prior.weights), kPriorPrecision});
  ScoreModel model;
  for (std::size_t i = 0; i < kScoreTerms; ++i) {
    model.weights.*kScoreTermList[i] = static_cast<float>(weights(static_cast<Eigen::Index>(i)));
  }
  return model;
}

}  // namespace houghstream
