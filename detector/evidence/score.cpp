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

Vector to_vector(const ScoreTerms& values) {
  return Eigen::Map<const Eigen::Array<float, kScoreTerms, 1>>(values.data()).cast<double>();
}

/// Minus the logarithm of what the weights make of the examples and of how far they leave the prior.
double loss_of(const std::vector<ScoreExample>& examples, const Vector& weights, const Vector& believed) {
  double loss = 0.5 * (weights - believed).squaredNorm();
  for (const ScoreExample& example : examples) {
    const double x = weights.dot(to_vector(example.terms)) * (example.is_object ? 1.0 : -1.0);
    loss += x > 0.0 ? std::log1p(std::exp(-x)) : -x + std::log1p(std::exp(x));
  }
  return loss;
}

/// Newton's step. Example by example: a product of large matrices sums in an order that depends on the caches.
Vector step_from(const std::vector<ScoreExample>& examples, const Vector& weights, const Vector& believed) {
  Vector gradient = believed - weights;
  Matrix curvature = Matrix::Identity();
  for (const ScoreExample& example : examples) {
    const Vector x = to_vector(example.terms);
    const double p = logistic(weights.dot(x));
    gradient += ((example.is_object ? 1.0 : 0.0) - p) * x;
    curvature.selfadjointView<Eigen::Lower>().rankUpdate(x, p * (1.0 - p));
  }
  return curvature.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
}

}  // namespace

ScoreTerms score_terms(const Evidence& evidence) {
  const ViewFit& fit = evidence.fit;
  const float foreign = std::min(fit.foreign_colour, 1.0F);
  constexpr float kNearest = 0.1F;  // metres, as far as a logarithm means something
  constexpr float kLeast = 1e-4F;   // the same of shares
  const float log_mass = std::log(std::max(evidence.mass_share, kLeast));
  const std::array<float, kScoreMeasures> measures = {log_mass,
                                                      std::log(1.02F - fit.hidden),
                                                      fit.seen_through,
                                                      fit.unknown,
                                                      fit.continued,
                                                      fit.likeness,
                                                      fit.hue_conflict,
                                                      foreign * foreign,
                                                      fit.unevenness,
                                                      evidence.other_size,
                                                      std::log(std::max(evidence.certainty, kLeast))};
  ScoreTerms terms{};
  terms[0] = 1.0F;
  std::copy(measures.begin(), measures.end(), terms.begin() + 1);
  terms[kScoreMeasures + 1] = fit.unknown * std::log(std::max(evidence.distance, kNearest));
  std::size_t next = kScoreMeasures + 2;
  for (std::size_t a = 0; a < kScoreMeasures; ++a) {
    for (std::size_t b = a; b < kScoreMeasures; ++b) terms[next++] = measures[a] * measures[b];
  }
  return terms;
}

float score(const ScoreModel& model, const Evidence& evidence) {
  return static_cast<float>(logistic(to_vector(model.weights).dot(to_vector(score_terms(evidence)))));
}

ScoreModel fit_score_model(const std::vector<ScoreExample>& examples, const ScoreModel& prior) {
  constexpr int kSteps = 50;  // of Newton's method, which needs about ten
  constexpr double kEnough = 1e-9;
  const Vector believed = to_vector(prior.weights);
  Vector weights = believed;
  double loss = loss_of(examples, weights, believed);
  for (int step = 0; step < kSteps; ++step) {
    Vector change = step_from(examples, weights, believed);
    // Far from the minimum a whole step may lead away from it.
    while (loss_of(examples, weights + change, believed) > loss && change.norm() > kEnough) change *= 0.5;
    weights += change;
    const double before = loss;
    loss = loss_of(examples, weights, believed);
    if (before - loss < kEnough) break;
  }
  ScoreModel model;
  for (std::size_t i = 0; i < kScoreTerms; ++i)
    model.weights[i] = static_cast<float>(weights(static_cast<Eigen::Index>(i)));
  return model;
}

}  // namespace houghstream
