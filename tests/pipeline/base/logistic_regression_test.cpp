#include "pipeline/base/logistic_regression.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/random.hpp"

namespace houghstream {
namespace {

using Weights = Eigen::Vector3d;

/// Drawn by the probabilities that the weights give.
std::vector<LogisticExample<3>> drawn_by(const Weights& weights, int count) {
  Random random(5);
  std::vector<LogisticExample<3>> examples(count);
  for (LogisticExample<3>& example : examples) {
    example.terms = {1.0, random.normal(), random.normal()};
    example.is_true = random.uniform() < logistic(weights.dot(example.terms));
  }
  return examples;
}

TEST(LogisticRegression, TheWeightsThatDrewTheExamplesComeBack) {
  const Weights truth(-0.5, 2.0, -1.0);
  const Weights found = fit_logistic<3>(drawn_by(truth, 20000), {Weights::Zero(), 1e-3});
  EXPECT_LT((found - truth).cwiseAbs().maxCoeff(), 0.1) << found.transpose();
}

TEST(LogisticRegression, NoOtherWeightsHaveLessLoss) {
  const std::vector<LogisticExample<3>> examples = drawn_by({1.0, 1.0, 0.0}, 200);
  const LogisticPrior<3> prior{Weights(0.0, 0.5, 0.0), 1.0};
  const Weights found = fit_logistic<3>(examples, prior);
  const double minimum = logistic_loss<3>(examples, found, prior);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double step : {-0.01, 0.01}) {
      EXPECT_GT(logistic_loss<3>(examples, found + step * Weights::Unit(axis), prior), minimum);
    }
  }
}

TEST(LogisticRegression, WithoutExamplesThePriorStays) {
  const Weights prior(1.0, -2.0, 3.0);
  EXPECT_EQ((fit_logistic<3>({}, {prior, 1.0})), prior);
}

TEST(LogisticRegression, ExamplesThatAPlanePartsGiveFiniteWeights) {
  const std::vector<LogisticExample<3>> examples = {{{1.0, -1.0, 0.0}, false}, {{1.0, 1.0, 0.0}, true}};
  const Weights found = fit_logistic<3>(examples, {Weights::Zero(), 1e-3});
  ASSERT_TRUE(found.allFinite());
  EXPECT_GT(found[1], 1.0);
  EXPECT_EQ(found[2], 0.0);
}

TEST(LogisticRegression, AHeldWeightStaysAndTheOthersFollowIt) {
  const Weights truth(0.5, -1.0, 2.0);
  const std::vector<LogisticExample<3>> examples = drawn_by(truth, 20000);
  const Weights prior(0.0, 1.0, 0.0);
  const Weights found = fit_logistic<3>(examples, {prior, 1e-3, 1});
  EXPECT_EQ(found[1], prior[1]);
  EXPECT_GT(found[2], 0.5);
  for (const int other : {0, 2}) {
    for (const double step : {-0.05, 0.05}) {
      const Weights moved = found + step * Weights::Unit(other);
      EXPECT_GT(logistic_loss<3>(examples, moved, {prior, 1e-3}), logistic_loss<3>(examples, found, {prior, 1e-3}));
    }
  }
}

}  // namespace
}  // namespace houghstream
