#include "pose/verification/quality_training.hpp"

#include <algorithm>

#include "pipeline/base/logistic_regression.hpp"

namespace houghstream {
namespace {

constexpr int kWeights = 1 + static_cast<int>(kQualityTerms.size());  // the bias first

using Weights = Eigen::Matrix<double, kWeights, 1>;

Weights to_vector(double bias, const QualityTerms& terms) {
  Weights out;
  out[0] = bias;
  for (std::size_t i = 0; i < kQualityTerms.size(); ++i)
    out[static_cast<Eigen::Index>(i) + 1] = terms.*kQualityTerms[i];
  return out;
}

/// Those of `otherwise` where no pose is right.
QualityTerms mean_of_right(const std::vector<QualityExample>& examples, const QualityTerms& otherwise) {
  QualityTerms sum;
  int count = 0;
  for (const QualityExample& example : examples) {
    if (!example.is_right) continue;
    ++count;
    for (const auto term : kQualityTerms) sum.*term += example.terms.*term;
  }
  if (count == 0) return otherwise;
  for (const auto term : kQualityTerms) sum.*term /= count;
  return sum;
}

}  // namespace

QualitySettings fit_quality_settings(const std::vector<QualityExample>& examples, const QualitySettings& prior,
                                     double stiffness) {
  std::vector<LogisticExample<kWeights>> judged;
  judged.reserve(examples.size());
  for (const QualityExample& example : examples) {
    judged.push_back({to_vector(1.0, example.terms), example.is_right});
    // Which of the two is right, not how likely that is: all else is the same, and drops out.
    if (example.of_other_print)
      judged.push_back({to_vector(1.0, example.terms) - to_vector(1.0, *example.of_other_print), true});
  }
  const Weights weights = fit_logistic<kWeights>(judged, {to_vector(prior.bias, prior.weights), stiffness});
  QualitySettings settings = prior;
  settings.bias = weights[0];
  for (std::size_t i = 0; i < kQualityTerms.size(); ++i)
    settings.weights.*kQualityTerms[i] = weights[static_cast<Eigen::Index>(i) + 1];
  settings.typical = mean_of_right(examples, prior.typical);
  return settings;
}

}  // namespace houghstream
