#include "detector/evidence/score.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace houghstream {
namespace {

using Vector = Eigen::Matrix<double, kScoreTerms, 1>;
using Matrix = Eigen::Matrix<double, kScoreTerms, kScoreTerms>;

double logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

Vector to_vector(const ScoreTerms& terms) {
  Vector out;
  for (std::size_t i = 0; i < kScoreTerms; ++i) out(static_cast<Eigen::Index>(i)) = terms.*kScoreTermList[i];
  return out;
}

/// Minus the logarithm of what the weights make of the examples and of how far they leave the prior.
double loss_of(const std::vector<ScoreExample>& examples, const Vector& weights, const Vector& prior) {
  double loss = 0.5 * (weights - prior).squaredNorm();
  for (const ScoreExample& example : examples) {
    const double x = weights.dot(to_vector(example.terms)) * (example.is_object ? 1.0 : -1.0);
    loss += x > 0.0 ? std::log1p(std::exp(-x)) : -x + std::log1p(std::exp(x));
  }
  return loss;
}

}  // namespace

ScoreTerms score_terms(const Evidence& evidence) {
  const ViewFit& fit = evidence.fit;
  const float foreign = std::min(fit.foreign_colour, 1.0F);
  constexpr float kNearest = 0.1F;  // metres, as far as a logarithm means something
  constexpr float kLeast = 1e-4F;   // the same of shares
  const float log_mass = std::log(std::max(evidence.mass_share, kLeast));
  const float log_shown = std::log(1.02F - fit.hidden);
  const float log_certainty = std::log(std::max(evidence.certainty, kLeast));
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
  return terms;
}

float score(const ScoreModel& model, const Evidence& evidence) {
  return static_cast<float>(logistic(to_vector(model.weights).dot(to_vector(score_terms(evidence)))));
}

ScoreModel fit_score_model(const std::vector<ScoreExample>& examples, const ScoreModel& prior) {
  constexpr int kSteps = 30;  // of Newton's method, which needs about eight
  const Vector expected = to_vector(prior.weights);
  Vector weights = expected;
  double loss = loss_of(examples, weights, expected);
  for (int step = 0; step < kSteps; ++step) {
    Vector gradient = expected - weights;
    Matrix curvature = Matrix::Identity();
    for (const ScoreExample& example : examples) {
      const Vector x = to_vector(example.terms);
      const double p = logistic(weights.dot(x));
      gradient += ((example.is_object ? 1.0 : 0.0) - p) * x;
      curvature += p * (1.0 - p) * x * x.transpose();
    }
    Vector change = curvature.ldlt().solve(gradient);
    // Far from the minimum a whole step may lead away from it.
    while (loss_of(examples, weights + change, expected) > loss && change.norm() > 1e-9) change *= 0.5;
    weights += change;
    loss = loss_of(examples, weights, expected);
  }
  ScoreModel model;
  for (std::size_t i = 0; i < kScoreTerms; ++i) {
    model.weights.*kScoreTermList[i] = static_cast<float>(weights(static_cast<Eigen::Index>(i)));
  }
  return model;
}

}  // namespace houghstream
