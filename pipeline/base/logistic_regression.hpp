#pragma once

#include <Eigen/Cholesky>
#include <cmath>
#include <optional>
#include <vector>

#include "pipeline/base/logit.hpp"

namespace houghstream {

/// Holds a labelled example: the values that the weights multiply, and the outcome.
template <int N>
struct LogisticExample {
  Eigen::Matrix<double, N, 1> terms = Eigen::Matrix<double, N, 1>::Zero();
  bool is_true = false;
};

/// Gives the Gaussian prior of a logistic regression's weights. `precision` is the inverse variance about the prior's
/// weights; a weight that is `fixed` keeps the prior's value.
template <int N>
struct LogisticPrior {
  Eigen::Matrix<double, N, 1> weights = Eigen::Matrix<double, N, 1>::Zero();
  double precision = 1.0;
  std::optional<int> fixed = std::nullopt;
};

/// Returns the negative log posterior of the weights, up to a constant.
template <int N>
double logistic_loss(const std::vector<LogisticExample<N>>& examples, const Eigen::Matrix<double, N, 1>& weights,
                     const LogisticPrior<N>& prior) {
  double loss = prior.precision * (0.5 * (weights - prior.weights).squaredNorm());
  for (const LogisticExample<N>& example : examples) {
    const double x = weights.dot(example.terms) * (example.is_true ? 1.0 : -1.0);
    loss += x > 0.0 ? std::log1p(std::exp(-x)) : -x + std::log1p(std::exp(x));
  }
  return loss;
}

/// Returns the weights of smallest loss by Newton's method (Bishop 2006, section 4.3.3). The prior keeps them finite
/// where the examples are linearly separable, and is returned for no examples.
template <int N>
Eigen::Matrix<double, N, 1> fit_logistic(const std::vector<LogisticExample<N>>& examples,
                                         const LogisticPrior<N>& prior) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  constexpr int kSteps = 30;  // it needs about eight
  Vector weights = prior.weights;
  double loss = logistic_loss<N>(examples, weights, prior);
  for (int step = 0; step < kSteps; ++step) {
    Vector gradient = prior.precision * (prior.weights - weights);
    Matrix hessian = prior.precision * Matrix::Identity();
    for (const LogisticExample<N>& example : examples) {
      const double p = logistic(weights.dot(example.terms));
      gradient += ((example.is_true ? 1.0 : 0.0) - p) * example.terms;
      hessian += p * (1.0 - p) * example.terms * example.terms.transpose();
    }
    if (prior.fixed) {
      gradient[*prior.fixed] = 0.0;
      hessian.row(*prior.fixed).setZero();
      hessian.col(*prior.fixed).setZero();
      hessian(*prior.fixed, *prior.fixed) = 1.0;
    }
    Vector change = hessian.ldlt().solve(gradient);
    // Far from the minimum a whole step may lead away from it.
    while (logistic_loss<N>(examples, weights + change, prior) > loss && change.norm() > 1e-9) change *= 0.5;
    weights += change;
    loss = logistic_loss<N>(examples, weights, prior);
  }
  return weights;
}

}  // namespace houghstream
