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
  const float foreign = std::min(fit.foreign_colour, 1.0F);
  constexpr float kNearest = 0.1F;  // metres, as far as a logarithm means something
  constexpr float kMin = 1e-4F;     // the same of shares
  constexpr float kUsualRadius_px = 40.0F;
  const float log_mass = std::log(std::max(evidence.relative_vote_mass, kMin));
  const float log_shown = std::log(1.02F - fit.hidden);
  const float log_certainty = std::log(std::max(evidence.certainty, kMin));
  ScoreTerms terms;
  terms.constant = 1.0F;
  terms.mass = log_mass;
  terms.shown = log_shown;
  terms.seen_through = fit.seen_through;
  terms.unknown = fit.unknown;
  terms.continued = fit.continued;
  terms.likeness = fit.likeness;
  terms.hue_conflict = fit.hue_conflict;
  terms.foreign_colour = foreign * foreign;
  terms.unevenness = fit.unevenness;
  terms.unknown_mass = fit.unknown * log_mass;
  terms.unknown_likeness = fit.unknown * fit.likeness;
  terms.unknown_distance = fit.unknown * std::log(std::max(evidence.distance, kNearest));
  terms.likeness_hue_conflict = fit.likeness * fit.hue_conflict;
  terms.other_size = evidence.other_size;
  terms.certainty = log_certainty;
  terms.shown_sq = log_shown * log_shown;
  terms.other_size_sq = evidence.other_size * evidence.other_size;
  terms.seen_through_certainty = fit.seen_through * log_certainty;
  terms.hue_conflict_foreign_colour = fit.hue_conflict * foreign * foreign;
  terms.unevenness_sq = fit.unevenness * fit.unevenness;
  terms.extent = std::log(std::max(evidence.radius_px, 1.0F) / kUsualRadius_px);
  terms.contrast = fit.contrast;
  terms.extent_likeness = terms.extent * fit.likeness;
  terms.contrast_likeness = fit.contrast * fit.likeness;
  terms.paleness = fit.paleness;
  terms.goes_on = evidence.outline.goes_on();
  terms.surface_goes_on = evidence.outline.surface_goes_on();
  terms.colour_goes_on = evidence.outline.colour_goes_on();
  terms.boundary_continuation_correlation = terms.goes_on * fit.likeness;
  return terms;
}

double log_odds(const ScoreModel& model, const ScoreTerms& terms) {
  return to_vector(model.weights).dot(to_vector(terms));
}

float score(const ScoreModel& model, const Evidence& evidence) {
  return static_cast<float>(logistic(log_odds(model, score_terms(evidence))));
}

float score_as_taught(const ScoreModel& model, const Evidence& evidence) {
  Evidence as_taught = evidence;
  as_taught.fit.foreign_colour = 0.2F;
  as_taught.fit.hue_conflict = 0.1F;
  as_taught.fit.paleness = 0.2F;
  return score(model, as_taught);
}

ScoreModel fit_score_model(const std::vector<ScoreExample>& examples, const ScoreModel& prior) {
  std::vector<LogisticExample<kScoreTerms>> judged;
  judged.reserve(examples.size());
  for (const ScoreExample& example : examples) judged.push_back({to_vector(example.terms), example.is_object});
  constexpr double kStiffness = 1.0;
  const Vector weights = fit_logistic<kScoreTerms>(judged, {to_vector(prior.weights), kStiffness});
  ScoreModel model;
  for (std::size_t i = 0; i < kScoreTerms; ++i) {
    model.weights.*kScoreTermList[i] = static_cast<float>(weights(static_cast<Eigen::Index>(i)));
  }
  return model;
}

}  // namespace houghstream
